//! Places beside poles and points without a normal: derivatives there are tiny, and their rounding must not be read as a crease.

use std::f64::consts::{FRAC_PI_2, TAU};

use perpend::{DVec3, Frame, Model, Place, Sphere, Torus};

fn frame() -> Frame {
    let (axis, xdir) = (DVec3::new(1.0, 2.0, 2.0) / 3.0, DVec3::new(2.0, 1.0, -2.0) / 3.0);
    Frame::new(DVec3::new(0.3, -0.7, 0.2), axis, xdir).expect("a frame")
}

#[test]
fn a_smooth_sphere_has_no_crease_beside_its_pole() {
    for centred in [true, false] {
        let frame = if centred { Frame::new(DVec3::ZERO, DVec3::Z, DVec3::X).expect("a frame") } else { frame() };
        let mut model = Model::new();
        let ball = Sphere { frame, radius: 1.0, latitude: (-FRAC_PI_2, 1.3), sweep: (0.0, TAU) };
        let id = model.insert("ball", ball).expect("valid");
        for exponent in 8..16 {
            for angle in [0.0, FRAC_PI_2, 0.3, TAU / 2.0] {
                let out = angle.cos() * frame.xdir + angle.sin() * frame.axis.cross(frame.xdir);
                let p = frame.centre - frame.axis + 6.6 * 10.0_f64.powi(-exponent) * out;
                let foot = model.project(id, p).expect("a good point");
                // where the derivative along v is no longer than its rounding, there is no telling whether there is a normal
                let is_lost = exponent >= 13 && foot.place == Place::Cusp && foot.normal.is_none();
                let allowed = [Place::Seam, Place::Interior, Place::Pole];
                assert!(is_lost || allowed.contains(&foot.place), "1e-{exponent} beside, at {angle}: {foot:?}");
                if let Some(normal) = foot.normal {
                    assert!(normal.dot(frame.axis) > 0.8, "1e-{exponent} beside, at {angle}: {foot:?}");
                }
            }
        }
    }
}

#[test]
fn the_point_where_a_horn_torus_meets_itself_is_a_cusp() {
    let horn = Torus { frame: frame(), major: 1.0, minor: 1.0, tube: (0.0, TAU), sweep: (0.0, TAU) };
    let mut model = Model::new();
    let id = model.insert("horn", horn).expect("valid");
    let foot = model.project(id, frame().centre).expect("a good point");
    assert!(foot.distance < 1e-15 && matches!(foot.place, Place::Cusp | Place::Pole), "{foot:?}");
    assert_eq!(foot.normal, None);
}
