//! Random definitions, records and models.

use std::collections::BTreeMap;

use perpend::glam::DVec2;
use perpend::kernel::Spacing;
use perpend::knowledge::{Break, Checked, Irregularity, ParameterPoint, SpanSpeed, Speed, Value};
use perpend::{
    Aabb, Basis, Carrier, Category, Classification, Cleaning, CurveData, DVec3, Definition, DefinitionData, Direction,
    EntityId, Fingerprint, Intent, Item, Kind, Model, Operation, Origin, Record, Relation, Relationship,
    Representation, Shell, SurfaceData, TrimCurveData, TrimLoopData, TrimmedSurface, TrimmingData, Units,
};
use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;

/// Any finite number, with the awkward ones often: both zeros, subnormals, the least and the greatest.
pub(crate) fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        3 => -9.0..9.0_f64,
        2 => prop::num::f64::POSITIVE | prop::num::f64::NEGATIVE | prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL,
        1 => prop::sample::select(vec![0.0, -0.0, f64::from_bits(1), f64::MIN_POSITIVE, f64::MAX, f64::MIN, 0.1, 1e21, 1e-7]),
    ]
}

/// A coordinate that a definition accepts.
fn coordinate() -> impl Strategy<Value = f64> {
    number().prop_map(|x| if x.abs() > 1e70 { 1e70_f64.copysign(x) } else { x })
}

pub(crate) fn vector() -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(number()).prop_map(DVec3::from_array)
}

fn point() -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(coordinate()).prop_map(DVec3::from_array)
}

/// A clamped knot vector with single interior knots, for `points` control points.
fn knots(degree: usize, points: usize, seed: &[u8]) -> Vec<f64> {
    let mut at = -0.0;
    let mut knots = vec![at; degree + 1];
    for k in 0..points - degree {
        at += f64::from(seed[k % seed.len()]) * 0.1 + 0.1;
        let times = if k + 1 == points - degree { degree + 1 } else { 1 };
        knots.extend(std::iter::repeat_n(at, times));
    }
    knots
}

fn weights(count: usize) -> impl Strategy<Value = Option<Vec<f64>>> {
    option::of(vec(prop_oneof![0.1..10.0_f64, Just(1.0), Just(1e-40), Just(1e40)], count))
}

fn curve() -> impl Strategy<Value = DefinitionData> {
    (1..=5_usize, 1..30_usize).prop_flat_map(|(degree, more)| {
        let count = degree + more;
        (vec(point(), count), weights(count), vec(any::<u8>(), 1..9)).prop_map(
            move |(control_points, weights, seed)| {
                let knots = knots(degree, count, &seed);
                DefinitionData::NurbsCurve(CurveData { degree, knots, control_points, weights })
            },
        )
    })
}

fn surface() -> impl Strategy<Value = DefinitionData> {
    (1..=3_usize, 1..5_usize, 1..=3_usize, 1..9_usize).prop_flat_map(|(p, rows, q, columns)| {
        let (rows, columns) = (p + rows, q + columns);
        (vec(point(), rows * columns), weights(rows * columns), vec(any::<u8>(), 1..9)).prop_map(
            move |(net, weights, seed)| {
                DefinitionData::NurbsSurface(SurfaceData {
                    degree: (p, q),
                    knots: (knots(p, rows, &seed), knots(q, columns, &seed)),
                    control_points: net.chunks(columns).map(<[DVec3]>::to_vec).collect(),
                    weights: weights.map(|weights| weights.chunks(columns).map(<[f64]>::to_vec).collect()),
                })
            },
        )
    })
}

/// A valid definition.
pub(crate) fn definition() -> impl Strategy<Value = Definition> {
    // all points equal is the one rule that the parts may break
    prop_oneof![curve(), surface()]
        .prop_filter_map("no extent", |data| data.enter().ok().map(|(definition, _)| definition))
}

/// A text with everything that needs care in RON.
pub(crate) fn text() -> impl Strategy<Value = String> {
    prop_oneof![
        Just(String::new()),
        Just("a \"quoted\" \\ back\nslash, // no comment /* none */ ) ] }".to_owned()),
        "\\PC{0,12}",
        vec(any::<char>(), 0..6).prop_map(|letters| letters.into_iter().collect()),
    ]
}

fn direction() -> impl Strategy<Value = Direction> {
    prop_oneof![Just(Direction::U), Just(Direction::V)]
}

fn range() -> impl Strategy<Value = (f64, f64)> {
    (number(), number())
}

fn basis() -> impl Strategy<Value = Basis> {
    prop_oneof![
        Just(Basis::Defined),
        number().prop_map(|gap| Basis::Proved { gap }),
        number().prop_map(|error| Basis::Measured { error }),
        (number(), any::<u64>()).prop_map(|(residual, points)| Basis::Fitted { residual, points }),
        Just(Basis::Declared),
    ]
}

fn fingerprint() -> impl Strategy<Value = Fingerprint> {
    any::<u64>().prop_map(|bits| format!("fnv1a64:{bits:016x}").parse().expect("16 digits"))
}

fn item<T: std::fmt::Debug>(value: impl Strategy<Value = T>) -> impl Strategy<Value = Item<T>> {
    (value, basis(), number(), fingerprint()).prop_map(|(value, basis, tolerance, of)| Item {
        value,
        basis,
        tolerance,
        of,
    })
}

fn items<T: std::fmt::Debug>(value: impl Strategy<Value = T>) -> impl Strategy<Value = Option<Vec<Item<T>>>> {
    option::of(vec(item(value), 0..3))
}

fn kind() -> impl Strategy<Value = Kind> {
    (prop::array::uniform3(vector()), prop::array::uniform2(number()), range(), range(), direction(), 0..12_u8)
        .prop_map(|([centre, axis, xdir], [radius, other], sweep, range, angular, which)| match which {
            0 => Kind::Line { origin: centre, direction: axis, range },
            1 => Kind::Circle { centre, axis, xdir, radius, sweep },
            2 => Kind::Ellipse { centre, axis, xdir, radii: (radius, other), sweep },
            3 => Kind::Plane { origin: centre, normal: axis, sides: None },
            4 => Kind::Plane { origin: centre, normal: axis, sides: Some((xdir, axis)) },
            5 => Kind::Sphere { centre, axis, xdir, radius, sweep, latitude: range, angular },
            6 => Kind::Cylinder { centre, axis, xdir, radius, height: range, sweep, angular },
            7 => Kind::Cone { apex: centre, axis, xdir, half_angle: radius, height: range, sweep, angular },
            8 => Kind::Torus {
                centre,
                axis,
                xdir,
                major_radius: radius,
                minor_radius: other,
                sweep,
                section: range,
                angular,
            },
            9 => Kind::Ruled { ruling: angular },
            10 => Kind::Revolution { origin: centre, axis, sweep: radius, angular },
            11 => Kind::Extrusion { vector: axis, along: angular },
            _ => Kind::FreeForm,
        })
}

fn classification() -> impl Strategy<Value = Classification> {
    let origin = prop_oneof![
        Just(Origin::Designed),
        (text(), text()).prop_map(|(format, from)| Origin::Imported { format, from }),
        (text(), any::<u64>(), number()).prop_map(|(from, points, residual)| Origin::Fitted { from, points, residual }),
        (text(), vec(Just(EntityId::new(1)), 0..3)).prop_map(|(operation, from)| Origin::Derived { operation, from }),
    ];
    (option::of(item(kind())), option::of(origin), vec(text(), 0..3))
        .prop_map(|(kind, origin, destination)| Classification { kind, origin, destination })
}

fn irregularity() -> impl Strategy<Value = Irregularity> {
    let place = (number(), number(), direction(), 0..3_u8).prop_map(|(u, v, direction, which)| match which {
        0 => ParameterPoint::Curve(u),
        1 => ParameterPoint::Surface(u, v),
        _ => ParameterPoint::Iso(direction, v),
    });
    (place, direction(), number(), number(), number(), 0..12_u8).prop_map(|(place, direction, at, much, to, which)| {
        match which {
            0 => Irregularity::Cusp { at: place, angle: much },
            1 => Irregularity::Pole { direction, at, extent: much },
            2 => Irregularity::Seam { direction, gap: much, order: None },
            9 => Irregularity::Seam { direction, gap: much, order: Some((2, 3)) },
            10 => Irregularity::VanishingNormal { at: place, area: much },
            11 => Irregularity::ZeroCurvature { from: at, to, curvature: much },
            3 => Irregularity::VanishingDerivative { direction, at: place, speed: much },
            4 => Irregularity::Crease { direction, at, angle: much },
            5 => Irregularity::Loop { from: at, to, gap: much },
            6 => Irregularity::Inflection { at: place, curvature: much },
            7 => Irregularity::NearKnots { direction, at, apart: much },
            _ => Irregularity::TinySpan { direction, at, extent: much },
        }
    })
}

fn representation() -> impl Strategy<Value = Representation> {
    let at = || {
        option::of(prop_oneof![
            number().prop_map(ParameterPoint::Curve),
            range().prop_map(|(u, v)| ParameterPoint::Surface(u, v)),
        ])
    };
    let category = (range(), text(), number()).prop_map(|((upper, tolerance), name, jitter)| Category {
        upper,
        name,
        tolerance,
        jitter,
    });
    let span = (range(), range(), number()).prop_map(|((from, to), (min, max), factor)| SpanSpeed {
        from,
        to,
        min,
        max,
        factor,
    });
    let speed = ((direction(), range(), number()), (at(), at()), option::of(category), vec(span, 0..3)).prop_map(
        |((direction, (min, max), factor), (min_at, max_at), category, spans)| Speed {
            direction,
            min,
            max,
            factor,
            min_at,
            max_at,
            category,
            spans,
        },
    );
    let break_ = (direction(), number(), any::<u32>(), any::<u32>(), range())
        .prop_map(|(direction, at, c, g, (c_within, g_within))| Break { direction, at, c, g, c_within, g_within });
    let bounds = (vector(), vector()).prop_map(|(min, max)| Aabb { min, max });
    let cleaning = prop_oneof![
        direction().prop_map(|direction| Cleaning::Clamped { direction }),
        (direction(), vec(number(), 0..4)).prop_map(|(direction, knots)| Cleaning::RemovedKnots { direction, knots }),
        (direction(), 1..25_usize).prop_map(|(direction, to)| Cleaning::ReducedDegree { direction, from: to + 1, to }),
        number().prop_map(|weight| Cleaning::DroppedWeights { weight }),
        (number(), number()).prop_map(|share| Cleaning::TrimClamped { share }),
        (direction(), vec(number(), 0..4), vec(number(), 0..4))
            .prop_map(|(direction, removed, added)| Cleaning::Purged { direction, removed, added }),
    ];
    (
        (items(speed), items(break_), items(irregularity()), items(cleaning)),
        (
            option::of(item(any::<(bool, bool)>())),
            option::of(item(any::<(bool, bool)>())),
            option::of(item(bounds)),
            option::of(item(range())),
        ),
        (option::of(item(number())), option::of(item(number()))),
    )
        .prop_map(
            |((speed, breaks, irregularities, cleaning), (closed, periodic, bounds, weights), (length, area))| {
                Representation {
                    speed,
                    breaks,
                    irregularities,
                    closed,
                    periodic,
                    bounds,
                    length,
                    area,
                    weights,
                    cleaning,
                }
            },
        )
}

fn operation() -> impl Strategy<Value = Operation> {
    prop_oneof![
        (vector(), vector(), number(), option::of(vector()))
            .prop_map(|(centre, axis, radius, xdir)| { Operation::CircleByCentre { centre, axis, radius, xdir } }),
        (vec(vector(), 0..20), 0..4_u64, spacing()).prop_map(|(points, columns, spacing)| Operation::Interpolation {
            degree: (3, 0),
            points,
            columns,
            spacing
        }),
        (number(), option::of(vector())).prop_map(|(distance, normal)| Operation::Offset { distance, normal }),
        (vector(), vector()).prop_map(|(x, translation)| Operation::Transform { columns: (x, x, x), translation }),
        Just(Operation::Rule),
        (direction(), range()).prop_map(|(direction, range)| Operation::Split { direction, range }),
        text().prop_map(|name| Operation::Other { name }),
    ]
}

fn spacing() -> impl Strategy<Value = Spacing> {
    prop::sample::select(vec![Spacing::Uniform, Spacing::ChordLength, Spacing::Centripetal])
}

fn relationship() -> impl Strategy<Value = Relationship> {
    let value = prop_oneof![
        number().prop_map(Value::Number),
        vec(number(), 0..4).prop_map(Value::Numbers),
        vector().prop_map(Value::Point),
        text().prop_map(Value::Text),
        any::<bool>().prop_map(Value::Flag),
    ];
    let relation = prop_oneof![Just(Relation::Profile), Just(Relation::FittedTo), text().prop_map(Relation::Other)];
    let checked = (number(), number(), fingerprint(), fingerprint())
        .prop_map(|(deviation, tolerance, of, target)| Checked { deviation, tolerance, of, target });
    (relation, vec((text(), value), 0..3), option::of(checked)).prop_map(|(kind, parameters, checked)| Relationship {
        kind,
        target: EntityId::new(1),
        parameters: parameters.into_iter().collect::<BTreeMap<_, _>>(),
        checked,
    })
}

/// A record whose only references are to entity 1.
pub(crate) fn record() -> impl Strategy<Value = Record> {
    let said = (vec(text(), 0..2), text());
    let intent = (operation(), vec(Just(EntityId::new(1)), 0..3), said, option::of(fingerprint())).prop_map(
        |(operation, inputs, (alternatives, decision), of)| Intent { operation, inputs, alternatives, decision, of },
    );
    (
        0..u64::MAX / 2,
        option::of(classification()),
        option::of(representation()),
        vec(intent, 0..3),
        vec(relationship(), 0..3),
    )
        .prop_map(|(revision, classification, representation, intent, relationships)| Record {
            revision,
            classification,
            representation,
            intent,
            relationships,
        })
}

/// A trim of a surface over the unit square: a triangle, as one p-curve or as three, with weights or without.
fn trimming() -> impl Strategy<Value = TrimmingData> {
    let corner = || (0.1..0.9_f64, 0.1..0.9_f64).prop_map(DVec2::from);
    let weights = option::of(vec(0.1..10.0_f64, 4));
    let corners = (corner(), corner(), corner()).prop_map(|(a, b, c)| [a, b, c, a]);
    let wide =
        corners.prop_filter("a triangle with an inside", |[a, b, c, _]| (*b - *a).perp_dot(*c - *a).abs() > 0.05);
    (wide, weights, any::<bool>(), any::<bool>(), prop_oneof![Just(0.0), 0.0..1.0_f64]).prop_map(
        |(corners, weights, is_one, reversed, tolerance)| {
            let curve = |points: &[DVec2], weights: Option<Vec<f64>>| {
                let last = (points.len() - 1) as f64;
                let inner = (0..points.len()).map(|k| k as f64);
                let knots = std::iter::once(0.0).chain(inner).chain([last]).collect();
                TrimCurveData { degree: 1, knots, points: points.to_vec(), weights, edge: None }
            };
            let curves = if is_one {
                vec![curve(&corners, weights)]
            } else {
                corners.windows(2).map(|side| curve(side, weights.as_ref().map(|w| w[..2].to_vec()))).collect()
            };
            TrimmingData { reversed, tolerance, loops: vec![TrimLoopData { outer: true, curves }] }
        },
    )
}

/// A trimmed face: of a carrier of its own, or of another entity.
fn faces() -> impl Strategy<Value = Vec<(String, TrimmingData, bool, Option<[f64; 3]>)>> {
    vec((text(), trimming(), any::<bool>(), option::of(prop::array::uniform3(0.0..=1.0_f64))), 0..4)
}

/// A model of a few entities with records, and of faces and a body of them.
pub(crate) fn model() -> impl Strategy<Value = Model> {
    (plain(), faces()).prop_map(|(mut model, faces)| {
        let at = |u: f64, v: f64| DVec3::new(u, v, u * v);
        let data = SurfaceData {
            degree: (1, 1),
            knots: (vec![0.0, 0.0, 1.0, 1.0], vec![0.0, 0.0, 1.0, 1.0]),
            control_points: vec![vec![at(0.0, 0.0), at(0.0, 1.0)], vec![at(1.0, 0.0), at(1.0, 1.0)]],
            weights: None,
        };
        let carrier = model.insert("carrier", data.clone()).expect("a valid surface");
        let mut ids = Vec::new();
        for (name, trimming, is_own, colour) in faces {
            let surface = if is_own {
                Carrier::Own(perpend::NurbsSurface::enter(data.clone()).expect("a valid surface").0)
            } else {
                Carrier::Ref(carrier)
            };
            let face = TrimmedSurface { surface, trimming };
            let id = model.insert_trimmed(&name, face).expect("a valid face");
            model.set_colour(id, colour).expect("a valid colour");
            ids.push(id);
        }
        if !ids.is_empty() {
            let shells = vec![Shell { faces: ids, closed: false }, Shell { faces: vec![carrier], closed: true }];
            model.insert_body("body", shells).expect("faces");
        }
        model
    })
}

/// A model of a few entities with records.
fn plain() -> impl Strategy<Value = Model> {
    let units = prop::sample::select(vec![Units::Millimetre, Units::Inch, Units::Micrometre, Units::Metre]);
    (units, vec((text(), definition(), option::of(record())), 0..4)).prop_map(|(units, entities)| {
        let mut model = Model::new();
        model.set_units(units);
        for (name, definition, record) in entities {
            let id = model.insert(&name, definition).expect("a valid definition");
            if let Some(mut record) = record {
                if id == EntityId::new(1) {
                    // nothing is made of itself
                    record.intent.iter_mut().for_each(|step| step.inputs.clear());
                }
                model.set_record(id, record).expect("a valid record");
            }
        }
        model
    })
}
