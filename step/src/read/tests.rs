//! Small files written by hand.

use std::f64::consts::PI;
use std::time::Duration;

use glam::DVec3;
use perpend::Units;

use super::{ReadError, ReadOptions, read};
use crate::source::{SourceCurve, SourceEdge, SourceLoop, SourcePart, SourceSurface};

/// A file with these entities.
fn file(data: &str) -> Vec<u8> {
    format!(
        "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n\
         FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n{data}ENDSEC;\nEND-ISO-10303-21;\n"
    )
    .into_bytes()
}

fn understood(data: &str) -> SourcePart {
    read(file(data), &ReadOptions::default()).expect("a valid file")
}

const MILLIMETRE: &str = "#1=(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.));\n";
const RADIAN: &str = "#2=(NAMED_UNIT(*) PLANE_ANGLE_UNIT() SI_UNIT($,.RADIAN.));\n";
const CONTEXT: &str = "#3=UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-4),#1,'distance_accuracy_value','');\n\
     #4=(GEOMETRIC_REPRESENTATION_CONTEXT(3) GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#3)) \
     GLOBAL_UNIT_ASSIGNED_CONTEXT((#1,#2)) REPRESENTATION_CONTEXT('',''));\n";

fn units() -> String {
    format!("{MILLIMETRE}{RADIAN}{CONTEXT}")
}

/// A product of this name with the representation `shape`, from entity `first` on; its definition is `first`.
fn product(first: usize, name: &str, shape: usize) -> String {
    let [formation, product, defined, stands] = [1, 2, 3, 4].map(|i| first + i);
    format!(
        "#{first}=PRODUCT_DEFINITION('design','',#{formation},$);\n#{formation}=PRODUCT_DEFINITION_FORMATION('','',#{product});\n\
         #{product}=PRODUCT('{name}','{name}','',());\n#{defined}=PRODUCT_DEFINITION_SHAPE('','',#{first});\n\
         #{stands}=SHAPE_DEFINITION_REPRESENTATION(#{defined},#{shape});\n"
    )
}

/// The unit cube as a solid, entity 100, with polygons for loops.
fn cube() -> String {
    let mut text = String::new();
    for i in 0..8 {
        text += &format!("#{}=CARTESIAN_POINT('',({}.,{}.,{}.));\n", 10 + i, i & 1, i >> 1 & 1, i >> 2 & 1);
    }
    text += "#21=DIRECTION('',(1.,0.,0.));\n#22=DIRECTION('',(0.,1.,0.));\n#23=DIRECTION('',(0.,0.,1.));\n";
    // corners of each side, counter-clockwise from outside; its normal, and whether that points outward
    let sides = [
        ([0, 4, 6, 2], 21, 22, ".F."),
        ([1, 3, 7, 5], 21, 22, ".T."),
        ([0, 1, 5, 4], 22, 23, ".F."),
        ([2, 6, 7, 3], 22, 23, ".T."),
        ([0, 2, 3, 1], 23, 21, ".F."),
        ([4, 5, 7, 6], 23, 21, ".T."),
    ];
    for (i, (corners, axis, xdir, sense)) in sides.iter().enumerate() {
        let at = 30 + 10 * i;
        let points: Vec<String> = corners.iter().map(|c| format!("#{}", 10 + c)).collect();
        text += &format!(
            "#{}=POLY_LOOP('',({}));\n#{}=FACE_OUTER_BOUND('',#{},.T.);\n#{}=AXIS2_PLACEMENT_3D('',#{},#{axis},#{xdir});\n\
             #{}=PLANE('',#{});\n#{}=ADVANCED_FACE('side {i}',(#{}),#{},{sense});\n",
            at,
            points.join(","),
            at + 1,
            at,
            at + 2,
            10 + corners[0],
            at + 3,
            at + 2,
            at + 4,
            at + 1,
            at + 3,
        );
    }
    text + "#90=CLOSED_SHELL('',(#34,#44,#54,#64,#74,#84));\n#100=MANIFOLD_SOLID_BREP('cube',#90);\n"
}

fn cube_in(context: &str) -> String {
    format!("{context}{}#101=ADVANCED_BREP_SHAPE_REPRESENTATION('',(#100),#4);\n{}", cube(), product(110, "box", 101))
}

#[test]
fn a_cube_has_six_faces_and_twelve_edges() {
    let colour = "#200=STYLED_ITEM('',(#201),#100);\n#201=PRESENTATION_STYLE_ASSIGNMENT((#202));\n\
        #202=SURFACE_STYLE_USAGE(.BOTH.,#203);\n#203=SURFACE_SIDE_STYLE('',(#204));\n#204=SURFACE_STYLE_FILL_AREA(#205);\n\
        #205=FILL_AREA_STYLE('',(#206));\n#206=FILL_AREA_STYLE_COLOUR('',#207);\n#207=COLOUR_RGB('',0.5,0.25,1.);\n\
        #210=OVER_RIDING_STYLED_ITEM('',(#211),#34,#200);\n#211=PRESENTATION_STYLE_ASSIGNMENT((#212));\n\
        #212=SURFACE_STYLE_USAGE(.BOTH.,#213);\n#213=SURFACE_SIDE_STYLE('',(#214));\n#214=SURFACE_STYLE_FILL_AREA(#215);\n\
        #215=FILL_AREA_STYLE('',(#216));\n#216=FILL_AREA_STYLE_COLOUR('',#217);\n#217=DRAUGHTING_PRE_DEFINED_COLOUR('red');\n";
    let part = understood(&(cube_in(&units()) + colour));
    assert_eq!(part.not_understood, []);
    assert_eq!((part.faces.len(), part.edges.len(), part.bodies.len()), (6, 12, 1));
    assert_eq!((part.units, part.tolerance), (Units::Millimetre, 1e-4));
    let body = &part.bodies[0];
    assert_eq!((body.entity, body.name.as_str(), body.colour), (100, "box/cube", Some([0.5, 0.25, 1.0])));
    assert!(body.shells.len() == 1 && body.shells[0].closed && !body.shells[0].reversed);
    assert_eq!(
        (part.faces[0].entity, part.faces[0].name.as_str(), part.faces[0].colour),
        (34, "side 0", Some([1.0, 0.0, 0.0]))
    );
    assert_eq!(part.faces[1].colour, None);
    assert_outward(&part);
}

/// Loops run counter-clockwise about outward normals, which point away from the middle of the part.
fn assert_outward(part: &SourcePart) {
    let middle = part.edges.iter().map(|edge| edge.start + edge.end).sum::<DVec3>() / (2 * part.edges.len()) as f64;
    for face in &part.faces {
        let SourceSurface::Plane(frame) = &face.surface else { panic!("{:?}", face.surface) };
        let outward = if face.same_sense { frame.axis } else { -frame.axis };
        let SourceLoop::Edges { uses, outer: true } = &face.loops[0] else { panic!("{:?}", face.loops) };
        let corners: Vec<DVec3> = uses.iter().map(|used| start(&part.edges[used.edge], used.forward)).collect();
        let around = (corners[1] - corners[0]).cross(corners[2] - corners[1]);
        assert!(around.dot(outward) > 0.0, "face #{}", face.entity);
        assert!((corners[0] - middle).dot(outward) > 0.0, "face #{}", face.entity);
    }
}

fn start(edge: &SourceEdge, forward: bool) -> DVec3 {
    if forward { edge.start } else { edge.end }
}

#[test]
fn a_body_without_a_product_is_read_all_the_same() {
    let loose = understood(&format!("{}{}", units(), cube()));
    assert_eq!((loose.faces.len(), loose.bodies.len()), (6, 1));
    let shell_only = cube().replace("#100=MANIFOLD_SOLID_BREP('cube',#90);\n", "");
    let part = understood(&format!("{}{shell_only}", units()));
    assert_eq!((part.faces.len(), part.bodies.len(), part.bodies[0].entity), (6, 1, 90));
    let faces_only = shell_only.replace("#90=CLOSED_SHELL('',(#34,#44,#54,#64,#74,#84));\n", "");
    let part = understood(&format!("{}{faces_only}", units()));
    assert_eq!((part.faces.len(), part.bodies.len()), (6, 6));
}

#[test]
fn a_reversed_bound_runs_the_other_way() {
    let text = cube_in(&units()).replace("#31=FACE_OUTER_BOUND('',#30,.T.)", "#31=FACE_OUTER_BOUND('',#30,.F.)");
    // the corners as given now run clockwise, and the flag mends them
    let text = text.replace("#30=POLY_LOOP('',(#10,#14,#16,#12))", "#30=POLY_LOOP('',(#12,#16,#14,#10))");
    assert_outward(&understood(&text));
}

/// A cylinder of radius 2 and height 5, its ends circles with one vertex, its side cut along a seam.
fn cylinder() -> String {
    "#10=CARTESIAN_POINT('',(0.,0.,0.));\n#11=DIRECTION('',(0.,0.,1.));\n#12=DIRECTION('',(1.,0.,0.));\n\
     #13=AXIS2_PLACEMENT_3D('',#10,#11,#12);\n#14=CYLINDRICAL_SURFACE('',#13,2.);\n#15=CARTESIAN_POINT('',(0.,0.,5.));\n\
     #16=AXIS2_PLACEMENT_3D('',#15,#11,#12);\n#17=CIRCLE('',#13,2.);\n#18=CIRCLE('',#16,2.);\n\
     #19=CARTESIAN_POINT('',(2.,0.,0.));\n#20=CARTESIAN_POINT('',(2.,0.,5.));\n#21=VERTEX_POINT('',#19);\n#22=VERTEX_POINT('',#20);\n\
     #23=VECTOR('',#11,2.5);\n#24=LINE('',#19,#23);\n#25=EDGE_CURVE('',#21,#21,#17,.T.);\n#26=EDGE_CURVE('',#22,#22,#18,.T.);\n\
     #40=DIRECTION('',(0.,1.));\n#41=VECTOR('',#40,2.5);\n#42=CARTESIAN_POINT('',(0.,0.));\n#43=LINE('',#42,#41);\n\
     #44=DEFINITIONAL_REPRESENTATION('',(#43),#4);\n#45=PCURVE('',#14,#44);\n#46=CARTESIAN_POINT('',(FULL,0.));\n#47=LINE('',#46,#41);\n\
     #48=DEFINITIONAL_REPRESENTATION('',(#47),#4);\n#49=PCURVE('',#14,#48);\n#50=SEAM_CURVE('',#24,(#45,#49),.CURVE_3D.);\n\
     #27=EDGE_CURVE('',#21,#22,#50,.T.);\n\
     #28=ORIENTED_EDGE('',*,*,#25,.T.);\n#29=ORIENTED_EDGE('',*,*,#26,.F.);\n#30=ORIENTED_EDGE('',*,*,#27,.T.);\n\
     #31=ORIENTED_EDGE('',*,*,#27,.F.);\n#32=EDGE_LOOP('',(#28,#30,#29,#31));\n#33=FACE_BOUND('',#32,.T.);\n\
     #34=ADVANCED_FACE('',(#33),#14,.T.);\n#35=ORIENTED_EDGE('',*,*,#25,.F.);\n#36=EDGE_LOOP('',(#35));\n#37=FACE_BOUND('',#36,.T.);\n\
     #38=PLANE('',#13);\n#39=ADVANCED_FACE('',(#37),#38,.F.);\n#51=ORIENTED_EDGE('',*,*,#26,.T.);\n#52=EDGE_LOOP('',(#51));\n\
     #53=FACE_BOUND('',#52,.T.);\n#54=PLANE('',#16);\n#55=ADVANCED_FACE('',(#53),#54,.T.);\n#56=CLOSED_SHELL('',(#34,#39,#55));\n\
     #57=MANIFOLD_SOLID_BREP('',#56);\n#58=ADVANCED_BREP_SHAPE_REPRESENTATION('',(#57),#4);\n"
        .to_owned()
}

#[test]
fn a_cylinder_is_known_by_its_axis_and_radius_and_keeps_its_seam() {
    let text = cylinder().replace("FULL", "6.283185307179586");
    let part = understood(&format!("{}{text}{}", units(), product(60, "pin", 58)));
    assert_eq!(part.not_understood, []);
    assert_eq!((part.faces.len(), part.edges.len(), part.bodies[0].name.as_str()), (3, 3, "pin"));
    let side = &part.faces[0];
    assert!(matches!(&side.surface, SourceSurface::Cylinder { frame, radius: 2.0 } if frame.axis == DVec3::Z));
    let SourceLoop::Edges { uses, outer: false } = &side.loops[0] else { panic!("{side:?}") };
    assert_eq!(uses.iter().map(|used| used.forward).collect::<Vec<_>>(), [true, true, false, false]);
    assert!(part.edges[0].closed && !part.edges[uses[1].edge].closed);
    let hints: Vec<_> = [1, 3].iter().map(|i| uses[*i].pcurve.as_ref().expect("a p-curve")).collect();
    assert_eq!((hints[0].points[0].x, hints[1].points[0].x), (0.0, 2.0 * PI));
    // both run as the line does, from the bottom to the top, over its own parameter
    assert!(hints.iter().all(|hint| hint.points[1].y == 5.0 && hint.knots == [0.0, 0.0, 2.0, 2.0]));
}

#[test]
fn degrees_become_radians() {
    let degree = "#5=(NAMED_UNIT(*) PLANE_ANGLE_UNIT() SI_UNIT($,.RADIAN.));\n\
        #6=PLANE_ANGLE_MEASURE_WITH_UNIT(PLANE_ANGLE_MEASURE(0.01745329252),#5);\n\
        #7=DIMENSIONAL_EXPONENTS(0.,0.,0.,0.,0.,0.,0.);\n#2=(CONVERSION_BASED_UNIT('DEGREES',#6) NAMED_UNIT(#7) PLANE_ANGLE_UNIT());\n";
    let text = cylinder()
        .replace("FULL", "360.")
        .replace("#14=CYLINDRICAL_SURFACE('',#13,2.)", "#14=CONICAL_SURFACE('',#13,2.,30.)");
    let part = understood(&format!("{MILLIMETRE}{degree}{CONTEXT}{text}{}", product(60, "pin", 58)));
    assert_eq!(part.not_understood, []);
    let SourceSurface::Cone { half_angle, .. } = part.faces[0].surface else { panic!("{:?}", part.faces[0]) };
    assert!((half_angle - PI / 6.0).abs() < 1e-15, "{half_angle}");
    let SourceLoop::Edges { uses, .. } = &part.faces[0].loops[0] else { panic!("{:?}", part.faces[0]) };
    let seam = uses[3].pcurve.as_ref().expect("a p-curve");
    assert!((seam.points[0].x - 2.0 * PI).abs() < 1e-14);
}

#[test]
fn inches_stay_inches_and_other_units_become_millimetres() {
    let inch = "#5=(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.));\n\
        #6=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#5);\n#7=DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);\n\
        #1=(CONVERSION_BASED_UNIT('INCH',#6) LENGTH_UNIT() NAMED_UNIT(#7));\n";
    let part = understood(&cube_in(&format!("{inch}{RADIAN}{CONTEXT}")));
    assert_eq!((part.units, largest(&part)), (Units::Inch, 1.0));
    assert!((part.tolerance - 1e-4).abs() < 1e-18, "{}", part.tolerance);
    let part = understood(&cube_in(&format!("{}{RADIAN}{CONTEXT}", MILLIMETRE.replace("MILLI", "DECI"))));
    assert_eq!(part.units, Units::Millimetre);
    assert!((largest(&part) - 100.0).abs() < 1e-12 && (part.tolerance - 1e-2).abs() < 1e-15);
    let part = understood(&cube_in(&format!("{RADIAN}{}", CONTEXT.replace("(#1,#2)", "(#2)"))));
    assert_eq!((part.units, part.faces.len()), (Units::Millimetre, 6));
    assert!(part.not_understood.iter().any(|left_out| left_out.entity == 4), "{:?}", part.not_understood);
}

fn largest(part: &SourcePart) -> f64 {
    part.edges.iter().map(|edge| edge.start.max(edge.end).max_element()).fold(0.0, f64::max)
}

/// An assembly of cubes: one moved by (10, 0, 0), one turned by 90 degrees about z as well.
fn assembly() -> String {
    cube_in(&units())
        + &product(120, "whole", 126)
        + "#126=SHAPE_REPRESENTATION('',(#130,#131,#132),#4);\n#127=DIRECTION('',(0.,1.,0.));\n#128=CARTESIAN_POINT('',(10.,0.,0.));\n\
           #129=CARTESIAN_POINT('',(0.,0.,0.));\n#130=AXIS2_PLACEMENT_3D('',#129,$,$);\n#131=AXIS2_PLACEMENT_3D('',#128,#23,#21);\n\
           #132=AXIS2_PLACEMENT_3D('',#128,#23,#127);\n"
        + &occurrence(140, "left", 131)
        + &occurrence(150, "right", 132)
}

/// The occurrence of the cube's product in that of `assembly` at a placement.
fn occurrence(first: usize, name: &str, placement: usize) -> String {
    let [occurs, defined, relation, map, placed] = [0, 1, 2, 3, 4].map(|i| first + i);
    format!(
        "#{occurs}=NEXT_ASSEMBLY_USAGE_OCCURRENCE('{first}','{name}','',#120,#110,$);\n#{defined}=PRODUCT_DEFINITION_SHAPE('','',#{occurs});\n\
         #{relation}=(REPRESENTATION_RELATIONSHIP('','',#101,#126) REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#{map}) \
         SHAPE_REPRESENTATION_RELATIONSHIP());\n#{map}=ITEM_DEFINED_TRANSFORMATION('','',#130,#{placement});\n\
         #{placed}=CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#{relation},#{defined});\n"
    )
}

#[test]
fn occurrences_are_placed_copies() {
    let part = understood(&assembly());
    assert_eq!(part.not_understood, []);
    assert_eq!((part.faces.len(), part.edges.len(), part.bodies.len()), (12, 24, 2));
    let names: Vec<&str> = part.bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(names, ["left/cube", "right/cube"]);
    let reach = |edges: &[SourceEdge]| {
        let points = || edges.iter().map(|edge| edge.start);
        (points().fold(DVec3::INFINITY, DVec3::min), points().fold(DVec3::NEG_INFINITY, DVec3::max))
    };
    assert_eq!(reach(&part.edges[..12]), (DVec3::new(10.0, 0.0, 0.0), DVec3::new(11.0, 1.0, 1.0)));
    // x goes to y, y to -x
    assert_eq!(reach(&part.edges[12..]), (DVec3::new(9.0, 0.0, 0.0), DVec3::new(10.0, 1.0, 1.0)));
    assert!(part.faces[6..].iter().flat_map(|face| &face.loops).all(
        |around| matches!(around, SourceLoop::Edges { uses, .. } if uses.iter().all(|used| (12..24).contains(&used.edge)))
    ));
    assert_eq!(part.bodies[1].shells[0].faces, [6, 7, 8, 9, 10, 11]);
}

#[test]
fn a_relation_may_be_written_the_other_way_round() {
    let turned = assembly()
        .replace("REPRESENTATION_RELATIONSHIP('','',#101,#126)", "REPRESENTATION_RELATIONSHIP('','',#126,#101)")
        .replace("ITEM_DEFINED_TRANSFORMATION('','',#130,#131)", "ITEM_DEFINED_TRANSFORMATION('','',#131,#130)")
        .replace("ITEM_DEFINED_TRANSFORMATION('','',#130,#132)", "ITEM_DEFINED_TRANSFORMATION('','',#132,#130)");
    let (turned, straight) = (understood(&turned), understood(&assembly()));
    for (a, b) in turned.edges.iter().zip(&straight.edges) {
        assert!(a.start.distance(b.start) < 1e-14 && a.end.distance(b.end) < 1e-14);
    }
}

#[test]
fn mapped_items_are_placed_copies() {
    let mapped = "#160=REPRESENTATION_MAP(#130,#101);\n#161=MAPPED_ITEM('',#160,#131);\n#162=MAPPED_ITEM('',#160,#132);\n\
        #163=MAPPED_ITEM('',#160,#164);\n#164=CARTESIAN_TRANSFORMATION_OPERATOR_3D('','',$,$,$,#129,2.,$);\n\
        #166=SHAPE_REPRESENTATION('',(#130,#161,#162,#163),#4);\n\
        #129=CARTESIAN_POINT('',(0.,0.,0.));\n#130=AXIS2_PLACEMENT_3D('',#129,$,$);\n#128=CARTESIAN_POINT('',(10.,0.,0.));\n\
        #131=AXIS2_PLACEMENT_3D('',#128,#23,#21);\n#127=DIRECTION('',(0.,1.,0.));\n#132=AXIS2_PLACEMENT_3D('',#128,#23,#127);\n";
    let text = format!(
        "{}{}#101=ADVANCED_BREP_SHAPE_REPRESENTATION('',(#100),#4);\n{}{mapped}",
        units(),
        cube(),
        product(120, "whole", 166)
    );
    let part = understood(&text);
    assert_eq!(part.not_understood, []);
    assert_eq!((part.faces.len(), part.bodies.len()), (18, 3));
    let last = &part.edges[24..];
    assert_eq!(last.iter().map(|edge| edge.start.max(edge.end).max_element()).fold(0.0, f64::max), 2.0);
    // a mirror is told of, and leaves the others where they are
    let mirror = text.replace("#129,2.,$)", "#129,2.,#165)").replace("'','',$,$,$,#129", "'','',$,$,#165,#129");
    let mirror = mirror + "#165=DIRECTION('',(0.,-1.,0.));\n";
    let mirror = mirror.replace("#129,2.,#165)", "#129,2.,$)");
    let part = understood(&mirror);
    assert_eq!((part.bodies.len(), part.not_understood.len()), (2, 1));
    assert!(part.not_understood[0].reason.contains("mirrors"), "{}", part.not_understood[0]);
}

#[test]
fn an_assembly_that_contains_itself_ends() {
    let cycle = assembly() + "#170=NEXT_ASSEMBLY_USAGE_OCCURRENCE('','again','',#110,#120,$);\n";
    let part = understood(&cycle);
    assert_eq!(part.faces.len(), 6, "the body is there once, since no root leads to it");
    assert!(
        part.not_understood.iter().any(|left_out| left_out.reason.contains("contains itself")),
        "{:?}",
        part.not_understood
    );
    // with a root above the cycle
    let root = product(180, "root", 186)
        + "#186=SHAPE_REPRESENTATION('',(#130),#4);\n#187=NEXT_ASSEMBLY_USAGE_OCCURRENCE('','top','',#180,#120,$);\n";
    let part = understood(&(cycle + &root));
    assert_eq!(part.bodies.len(), 2);
    assert!(part.not_understood.iter().any(|left_out| left_out.entity == 170), "{:?}", part.not_understood);
}

#[test]
fn doubling_assemblies_end_with_an_error() {
    // 40 levels, each with the one below twice
    let mut text = assembly();
    for level in 0..40 {
        let (at, below) = (1000 + 10 * level, if level == 0 { 120 } else { 990 + 10 * level });
        text += &product(at, "level", 101_000);
        text += &format!(
            "#{}=NEXT_ASSEMBLY_USAGE_OCCURRENCE('','a','',#{at},#{below},$);\n#{}=NEXT_ASSEMBLY_USAGE_OCCURRENCE('','b','',#{at},#{below},$);\n",
            at + 5,
            at + 6
        );
    }
    let error = read(file(&text), &ReadOptions::default()).expect_err("too many copies");
    assert!(matches!(error, ReadError::TooManyCopies { .. }), "{error}");
    let few = ReadOptions { max_pieces: 60, ..ReadOptions::default() };
    let error = read(file(&assembly()), &few).expect_err("two copies of 54 pieces");
    assert!(matches!(error, ReadError::TooManyCopies { entity: 100, limit: 60 }), "{error}");
}

#[test]
fn a_face_that_is_not_understood_is_listed_and_opens_its_shell() {
    let text = cube_in(&units()).replace("#33=PLANE('',#32)", "#33=BLENDED_SURFACE('',#32)");
    let part = understood(&text);
    assert_eq!((part.faces.len(), part.bodies[0].shells[0].closed), (5, false));
    let listed: Vec<String> = part.not_understood.iter().map(ToString::to_string).collect();
    assert_eq!(listed, ["#34 ADVANCED_FACE: its #33 BLENDED_SURFACE: this kind is not read as a surface"]);
    let text = cube_in(&units()).replace("#33=PLANE('',#32);\n", "");
    let part = understood(&text);
    assert!(
        part.not_understood[0].reason.contains("#33 (absent): the file lacks this entity"),
        "{}",
        part.not_understood[0]
    );
    assert_eq!(part.faces.len(), 5);
}

/// The cylinder with this curve for the edge at its bottom.
fn with_bottom(curve: &str) -> SourcePart {
    let text = cylinder().replace("FULL", "6.283185307179586").replace("#17=CIRCLE('',#13,2.)", curve);
    understood(&format!("{}{text}{}", units(), product(60, "pin", 58)))
}

#[test]
fn curves_come_in_many_spellings() {
    let part = with_bottom(
        "#17=TRIMMED_CURVE('',#70,(PARAMETER_VALUE(0.)),(PARAMETER_VALUE(0.)),.F.,.PARAMETER.);\n#70=CIRCLE('',#13,2.)",
    );
    let SourceCurve::Circle { frame, radius: 2.0 } = part.edges[0].curve else { panic!("{:?}", part.edges[0]) };
    assert_eq!((frame.axis, frame.xdir), (-DVec3::Z, DVec3::X));
    let corners = "#71=CARTESIAN_POINT('',(0.,2.,0.));\n#72=CARTESIAN_POINT('',(-2.,0.,0.))";
    let part = with_bottom(&format!("#17=POLYLINE('',(#19,#71,#72,#19));\n{corners}"));
    let SourceCurve::Nurbs(curve) = &part.edges[0].curve else { panic!("{:?}", part.edges[0]) };
    assert_eq!((curve.degree(), curve.domain(), curve.point(1.5)), (1, (0.0, 3.0), DVec3::new(-1.0, 1.0, 0.0)));
    // half a circle, then two straight pieces back, the second one run the other way
    let part = with_bottom(&format!(
        "#17=COMPOSITE_CURVE('',(#73,#74),.F.);\n{corners};\n#73=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#75);\n\
         #74=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.F.,#76);\n#70=CIRCLE('',#13,2.);\n\
         #75=TRIMMED_CURVE('',#70,(#19),(#72),.T.,.CARTESIAN.);\n#76=POLYLINE('',(#19,#71,#72))"
    ));
    let SourceCurve::Nurbs(curve) = &part.edges[0].curve else { panic!("{:?}", part.edges[0]) };
    assert_eq!(curve.domain(), (0.0, 2.0));
    let about =
        |u: f64, x: f64, y: f64| assert!(curve.point(u).distance(DVec3::new(x, y, 0.0)) < 1e-14, "{}", curve.point(u));
    about(0.5, 0.0, 2.0);
    about(1.0, -2.0, 0.0);
    about(1.25, -1.0, 1.0);
    about(2.0, 2.0, 0.0);
    // two Bézier pieces of degree 2
    let part = with_bottom(&format!("#17=BEZIER_CURVE('',2,(#19,#71,#72,#71,#19),.UNSPECIFIED.,.F.,.F.);\n{corners}"));
    let SourceCurve::Nurbs(curve) = &part.edges[0].curve else { panic!("{:?}", part.edges[0]) };
    assert_eq!(curve.knots().as_slice(), [0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0]);
    // the weights of an entity with several keywords
    let part = with_bottom(&format!(
        "#17=(BOUNDED_CURVE() B_SPLINE_CURVE(2,(#19,#71,#72),.UNSPECIFIED.,.F.,.F.) B_SPLINE_CURVE_WITH_KNOTS((3,3),(0.,1.),.UNSPECIFIED.) \
         CURVE() GEOMETRIC_REPRESENTATION_ITEM() RATIONAL_B_SPLINE_CURVE((1.,0.5,1.)) REPRESENTATION_ITEM(''));\n{corners}"
    ));
    let SourceCurve::Nurbs(curve) = &part.edges[0].curve else { panic!("{:?}", part.edges[0]) };
    assert_eq!(curve.weights(), Some(&[1.0, 0.5, 1.0][..]));
}

#[test]
fn counts_that_a_file_declares_make_no_room() {
    let part = with_bottom(
        "#17=B_SPLINE_CURVE_WITH_KNOTS('',1,(#19,#20),.UNSPECIFIED.,.F.,.F.,(9000000000000000000,2),(0.,1.),.UNSPECIFIED.)",
    );
    assert!(part.not_understood[0].reason.contains("do not add up"), "{}", part.not_understood[0]);
    assert_eq!(part.faces.len(), 1, "two of three faces have that edge");
    let part = with_bottom("#17=BEZIER_CURVE('',9000000000000000000,(#19,#20),.UNSPECIFIED.,.F.,.F.)");
    assert!(part.not_understood[0].reason.contains("too few"), "{}", part.not_understood[0]);
}

/// The cylinder with this surface for its side.
fn with_side(surface: &str) -> SourcePart {
    let text = cylinder().replace("FULL", "6.283185307179586").replace("#14=CYLINDRICAL_SURFACE('',#13,2.)", surface);
    understood(&format!("{}{text}{}", units(), product(60, "pin", 58)))
}

#[test]
fn surfaces_come_in_many_spellings() {
    let part = with_side("#14=OFFSET_SURFACE('',#70,0.5,.F.);\n#70=CYLINDRICAL_SURFACE('',#13,1.5)");
    assert!(matches!(part.faces[0].surface, SourceSurface::Cylinder { radius: 2.0, .. }));
    let part =
        with_side("#14=RECTANGULAR_TRIMMED_SURFACE('',#70,0.,1.,0.,1.,.T.,.F.);\n#70=CYLINDRICAL_SURFACE('',#13,2.)");
    assert!(matches!(part.faces[0].surface, SourceSurface::Cylinder { radius: 2.0, .. }));
    assert!(!part.faces[0].same_sense);
    let part = with_side("#14=SURFACE_OF_LINEAR_EXTRUSION('',#17,#23)");
    let SourceSurface::Extrusion { profile: SourceCurve::Circle { .. }, direction } = part.faces[0].surface else {
        panic!("{:?}", part.faces[0])
    };
    assert_eq!(direction, DVec3::new(0.0, 0.0, 2.5));
    let part = with_side("#14=SURFACE_OF_REVOLUTION('',#24,#70);\n#70=AXIS1_PLACEMENT('',#10,#11)");
    assert!(matches!(part.faces[0].surface, SourceSurface::Revolution { profile: SourceCurve::Line { .. }, .. }));
    let part = with_side("#14=DEGENERATE_TOROIDAL_SURFACE('',#13,1.,3.,.T.)");
    let SourceSurface::Revolution { profile: SourceCurve::Circle { frame, radius: 3.0 }, .. } = part.faces[0].surface
    else {
        panic!("{:?}", part.faces[0])
    };
    // from the equator towards the axis of the torus
    assert_eq!((frame.centre, frame.xdir, frame.ydir()), (DVec3::X, DVec3::X, DVec3::Z));
    let corners = "#71=CARTESIAN_POINT('',(2.,2.,0.));\n#72=CARTESIAN_POINT('',(2.,2.,5.))";
    let part = with_side(&format!(
        "#14=QUASI_UNIFORM_SURFACE('',1,1,((#19,#20),(#71,#72)),.UNSPECIFIED.,.F.,.F.,.F.);\n{corners}"
    ));
    let SourceSurface::Nurbs(surface) = &part.faces[0].surface else { panic!("{:?}", part.faces[0]) };
    assert_eq!(surface.point(1.0, 0.0), DVec3::new(2.0, 2.0, 0.0));
}

#[test]
fn chains_of_references_end() {
    let mut chain = "#14=OFFSET_SURFACE('',#10000,0.,.F.)".to_owned();
    for i in 10_000..30_000 {
        chain += &format!(";\n#{i}=OFFSET_SURFACE('',#{},0.,.F.)", i + 1);
    }
    let part = with_side(&chain);
    assert!(part.not_understood[0].reason.contains("nested too deeply"), "{}", part.not_understood[0]);
    let part = with_bottom("#17=TRIMMED_CURVE('',#17,(PARAMETER_VALUE(0.)),(PARAMETER_VALUE(0.)),.T.,.PARAMETER.)");
    assert!(part.not_understood[0].reason.contains("nested too deeply"), "{}", part.not_understood[0]);
}

#[test]
fn curves_that_double_without_end_are_an_error() {
    let mut chain = "#17=COMPOSITE_CURVE('',(#10000,#10000),.F.)".to_owned();
    for i in (10_000..10_080).step_by(2) {
        chain += &format!(";\n#{i}=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#{})", i + 1);
        chain += &format!(";\n#{}=COMPOSITE_CURVE('',(#{},#{}),.F.)", i + 1, i + 2, i + 2);
    }
    chain += ";\n#10080=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#70);\n#70=POLYLINE('',(#19,#20,#19))";
    let text = cylinder().replace("FULL", "0.").replace("#17=CIRCLE('',#13,2.)", &chain);
    let text = format!("{}{text}{}", units(), product(60, "pin", 58));
    let error = read(file(&text), &ReadOptions::default()).expect_err("2^41 pieces");
    assert!(matches!(error, ReadError::TooManyCopies { .. }), "{error}");
}

#[test]
fn damaged_files_are_errors_with_their_place() {
    let whole = file(&cube_in(&units()));
    let cut = whole[..whole.len() / 2].to_vec();
    let error = read(cut.clone(), &ReadOptions::default()).expect_err("a file cut short");
    assert!(
        matches!(error, ReadError::CutShort { line } if line > 10) || error.to_string().contains("line"),
        "{error}"
    );
    // wherever it is cut, it is an error and no panic
    for at in (0..whole.len() - 30).step_by(97) {
        read(whole[..at].to_vec(), &ReadOptions::default()).expect_err("a file cut short");
    }
    let rubbish: Vec<u8> = (0..5000_u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 13) as u8).collect();
    let error = read(rubbish, &ReadOptions::default()).expect_err("no STEP file");
    assert!(matches!(error, ReadError::NotStep { .. }), "{error}");
    let error = read(Vec::new(), &ReadOptions::default()).expect_err("an empty file");
    assert!(matches!(error, ReadError::NotStep { .. }), "{error}");
    let deep = format!("#1=A({}{});\n", "(".repeat(1_000_000), ")".repeat(1_000_000));
    let error = read(file(&deep), &ReadOptions::default()).expect_err("nested too deeply");
    assert!(error.to_string().contains("line 8") && error.to_string().contains("nesting"), "{error}");
}

#[test]
fn limits_are_kept() {
    let small = ReadOptions { max_bytes: 100, ..ReadOptions::default() };
    let error = read(file(&cube()), &small).expect_err("too large");
    assert!(matches!(error, ReadError::TooLarge { limit: 100, .. }), "{error}");
    let bytes = file(&format!("#1=A({});\n", ",".repeat(4000)));
    let small = ReadOptions { max_bytes: bytes.len() as u64, ..ReadOptions::default() };
    let error = read(bytes, &small).expect_err("too many values");
    assert!(matches!(error, ReadError::TooManyValues { .. }), "{error}");
    let short = ReadOptions { max_time: Duration::ZERO, ..ReadOptions::default() };
    let many: String = (1..200_000).map(|i| format!("#{i}=DIRECTION('',(0.,0.,1.));\n")).collect();
    let error = read(file(&many), &short).expect_err("too slow");
    assert!(matches!(error, ReadError::TooSlow { .. }), "{error}");
}

/// The cube with these boundaries of its first face.
fn cube_bounded_by(bounds: &[String], more: &str) -> Vec<u8> {
    let text = cube_in(&units());
    assert!(text.contains("(#31)"));
    file(&(text.replace("(#31)", &format!("({})", bounds.join(","))) + more))
}

#[test]
fn boundaries_are_counted_as_often_as_they_are_used() {
    let again = vec!["#31".to_owned(); 5000];
    let part = read(cube_bounded_by(&again, ""), &ReadOptions::default()).expect("a valid file");
    assert_eq!((part.faces.len(), part.faces[0].loops.len()), (6, 1), "boundaries are a set");
    // many around one loop
    let (mut bounds, mut more) = (Vec::new(), String::new());
    for i in 1000..1500 {
        bounds.push(format!("#{i}"));
        more += &format!("#{i}=FACE_BOUND('',#30,.T.);\n");
    }
    let bytes = cube_bounded_by(&bounds, &more);
    let options = |max_pieces| ReadOptions { max_pieces, ..ReadOptions::default() };
    // 500 loops of 4 sides, each a use and perhaps an edge
    let error = read(bytes.clone(), &options(4400)).expect_err("more uses than pieces");
    assert!(matches!(error, ReadError::TooManyCopies { entity: 30, limit: 4400 }), "{error}");
    assert_eq!(read(bytes, &options(4600)).expect("few enough").faces[0].loops.len(), 500);
}

#[test]
fn a_long_name_counts_in_every_copy() {
    let text = assembly().replace("'side 0'", &format!("'{}'", "x".repeat(64_000)));
    let options = |max_pieces| ReadOptions { max_pieces, ..ReadOptions::default() };
    let error = read(file(&text), &options(2000)).expect_err("two copies of a thousand pieces");
    assert!(matches!(error, ReadError::TooManyCopies { entity: 100, limit: 2000 }), "{error}");
    assert_eq!(read(file(&text), &options(2200)).expect("room for both").bodies.len(), 2);
}

#[test]
fn a_shell_that_is_not_closed_is_not_called_so() {
    let text = cube_in(&units()).replace(",#74,#84)", ",#74)");
    let part = understood(&text);
    // the sixth is a body of its own
    assert_eq!((part.faces.len(), part.bodies.len(), part.bodies[0].shells[0].closed), (6, 2, false));
    let [left_out] = &part.not_understood[..] else { panic!("{:?}", part.not_understood) };
    assert_eq!((left_out.entity, left_out.keyword.as_str()), (90, "CLOSED_SHELL"));
    assert!(left_out.reason.contains("once in either direction"), "{left_out}");
    // one of its faces turned
    let part = understood(&cube_in(&units()).replace("FACE_OUTER_BOUND('',#30,.T.)", "FACE_OUTER_BOUND('',#30,.F.)"));
    assert_eq!((part.faces.len(), part.bodies[0].shells[0].closed, part.not_understood.len()), (6, false, 1));
}

fn listed(part: &SourcePart) -> Vec<(u64, &str)> {
    part.not_understood.iter().map(|left_out| (left_out.entity, left_out.keyword.as_str())).collect()
}

#[test]
fn geometry_that_no_product_leads_to_is_listed() {
    let beside = "#300=SPHERE('',5.,#10);\n#301=CSG_SOLID('',#300);\n#302=CSG_SHAPE_REPRESENTATION('',(#301),#4);\n\
        #303=GEOMETRIC_CURVE_SET('',(#10));\n#304=GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION('',(#303),#4);\n\
        #305=TESSELLATED_SHELL('',#306,$);\n#307=TESSELLATED_SHAPE_REPRESENTATION('',(#305),#4);\n\
        #308=EXTRUDED_AREA_SOLID('',#30,#32,#21,5.);\n";
    let part = understood(&(cube_in(&units()) + beside));
    assert_eq!(part.faces.len(), 6);
    let wanted =
        [(301, "CSG_SOLID"), (308, "EXTRUDED_AREA_SOLID"), (303, "GEOMETRIC_CURVE_SET"), (305, "TESSELLATED_SHELL")];
    assert_eq!(listed(&part), wanted);
    // nothing at all
    let part = understood(&units());
    assert_eq!(listed(&part).len(), 1, "{:?}", part.not_understood);
    assert!(part.not_understood[0].reason.contains("holds no faces"), "{}", part.not_understood[0]);
}
