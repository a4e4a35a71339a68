//! The proven deviation of two definitions: no smaller than what is measured, and not much larger where that can be had.

use perpend::kernel::glam::DAffine3;
use perpend::knowledge::deviation;
use perpend::{
    CurveData, DVec3, Definition, DefinitionData, Difference, Direction, NurbsCurve, NurbsSurface, SurfaceData,
};

use crate::common::random::Random;

fn curve(random: &mut Random, rational: bool, at: DVec3) -> NurbsCurve {
    let (degree, more) = (random.count(1, 5), random.count(1, 6));
    let count = degree + more;
    let mut knots = vec![0.0; degree + 1];
    knots.extend((1..more).map(|k| k as f64 / more as f64));
    knots.extend(vec![1.0; degree + 1]);
    let control_points = (0..count).map(|_| at + random.in_cube()).collect();
    let weights = rational.then(|| (0..count).map(|_| random.power(-1.0, 1.0)).collect());
    let (definition, _) =
        DefinitionData::NurbsCurve(CurveData { degree, knots, control_points, weights }).enter().expect("valid");
    let Definition::NurbsCurve(curve) = definition else { panic!("a curve") };
    curve
}

fn surface(random: &mut Random, rational: bool, at: DVec3) -> NurbsSurface {
    let degree = (random.count(1, 3), random.count(1, 3));
    let knots = |degree: usize| {
        let mut knots = vec![0.0; degree + 1];
        knots.push(0.4);
        knots.extend(vec![1.0; degree + 1]);
        knots
    };
    let (rows, columns) = (degree.0 + 2, degree.1 + 2);
    let control_points = (0..rows).map(|_| (0..columns).map(|_| at + random.in_cube()).collect()).collect();
    let weights =
        rational.then(|| (0..rows).map(|_| (0..columns).map(|_| random.power(-1.0, 1.0)).collect()).collect());
    let data = SurfaceData { degree, knots: (knots(degree.0), knots(degree.1)), control_points, weights };
    let Definition::NurbsSurface(surface) = DefinitionData::NurbsSurface(data).enter().expect("valid").0 else {
        panic!("a surface")
    };
    surface
}

fn places() -> [DVec3; 3] {
    [DVec3::ZERO, DVec3::new(3e3, -1e3, 0.0), DVec3::splat(1e9)]
}

#[test]
fn a_change_of_basis_is_proved_to_be_rounding() {
    let mut random = Random::new(7);
    for k in 0..200 {
        let at = places()[k % 3];
        let one = curve(&mut random, k % 2 == 0, at);
        let u = random.between(0.05, 0.95);
        let other = one.elevate_degree(random.count(0, 3)).expect("valid").insert_knot(u, 1).expect("valid");
        let found = deviation(&one.clone().into(), &other.into());
        // the kernel rounds where the curve is, so that a curve far out is off by its coordinates' rounding
        let most = 1e-12 + 64.0 * f64::EPSILON * at.abs().max_element();
        assert!(found.proven > 0.0 && found.proven < most, "{k}: {found:?}");
        assert!(found.measured <= found.proven && found.differs.contains(&Difference::Knots), "{k}: {found:?}");
        let one = surface(&mut random, k % 2 == 1, at);
        let other = one.elevate_degree(Direction::V, 1).expect("valid").insert_knot(Direction::U, u, 1).expect("valid");
        let found = deviation(&one.into(), &other.into());
        assert!(found.measured <= found.proven && found.proven < most, "{k}: {found:?}");
        assert_eq!(found.differs, [Difference::Degree, Difference::Knots]);
    }
}

#[test]
fn a_shift_is_bounded_by_its_length_and_met() {
    let mut random = Random::new(11);
    for k in 0..200 {
        let (at, shift) = (places()[k % 3], random.power(-5.0, 0.0) * random.direction());
        let map = DAffine3::from_translation(shift);
        let (one, other): (Definition, Definition) = if k % 2 == 0 {
            let one = curve(&mut random, k % 4 == 0, at);
            let other = one.transformed(&map).expect("valid").elevate_degree(k % 3).expect("valid");
            (one.into(), other.into())
        } else {
            let one = surface(&mut random, k % 4 == 1, at);
            let other = one.transformed(&map).expect("valid").elevate_degree(Direction::U, k % 3).expect("valid");
            (one.into(), other.into())
        };
        for (a, b) in [(&one, &other), (&other, &one)] {
            let found = deviation(a, b);
            let rounding = 1e-12 + 64.0 * f64::EPSILON * at.abs().max_element();
            assert!(
                found.proven >= shift.length() - rounding && found.proven <= shift.length() + rounding,
                "{k}: {found:?}"
            );
            assert!(found.measured >= shift.length() - rounding && found.measured <= found.proven, "{k}: {found:?}");
        }
    }
}

#[test]
fn no_parameter_is_farther_apart_than_proven() {
    let mut random = Random::new(13);
    for k in 0..300 {
        let (at, near) = (places()[k % 3], random.power(-9.0, 0.0));
        let one = curve(&mut random, k % 2 == 0, at);
        let points: Vec<DVec3> = one.control_points().iter().map(|p| *p + near * random.in_cube()).collect();
        let weights =
            one.weights().map(|w| w.iter().map(|w| 3.0 * w * (1.0 + near * random.between(-0.5, 0.5))).collect());
        let other = NurbsCurve::new(one.degree(), one.knots().as_slice().to_vec(), points, weights).expect("valid");
        let other = other.elevate_degree(k % 2).expect("valid");
        let found = deviation(&one.clone().into(), &other.clone().into());
        let rounding = 32.0 * f64::EPSILON * (1.0 + at.abs().max_element());
        let mut met = 0.0_f64;
        for _ in 0..200 {
            let u = random.unit();
            met = met.max(one.point(u).distance(other.point(u)));
        }
        assert!(met <= found.proven + rounding, "{k}: {met} and {found:?}");
        // weights of which one set is three times the other are no difference; control points are the bound's own looseness
        assert!(found.proven <= 40.0 * near + rounding, "{k}: {near} and {found:?}");
    }
}

#[test]
fn what_cannot_be_compared_point_by_point_is_bounded_as_two_sets() {
    let mut random = Random::new(17);
    let one = curve(&mut random, true, DVec3::ZERO);
    let other = one.with_domain(0.0, 2.0).expect("valid");
    let found = deviation(&one.clone().into(), &other.into());
    assert!(found.differs.contains(&Difference::Domain) && found.proven >= 0.1 && found.measured < 1e-12, "{found:?}");
    let sheet: Definition = surface(&mut random, false, DVec3::ZERO).into();
    let found = deviation(&one.clone().into(), &sheet);
    let both = Definition::from(one.clone()).control_box().join(sheet.control_box());
    assert_eq!(found.differs, [Difference::Kind]);
    assert!(found.proven >= both.diagonal() && found.proven <= both.diagonal() * (1.0 + 1e-14), "{found:?}");
    let same = deviation(&sheet, &sheet);
    assert_eq!((same.proven, same.measured, same.is_same_structure()), (0.0, 0.0, true));
}

#[test]
fn extreme_numbers_give_finite_bounds() {
    let line = |from: DVec3, to: DVec3, weights| -> Definition {
        NurbsCurve::new(1, vec![0.0, 0.0, 1.0, 1.0], vec![from, to], weights).expect("valid").into()
    };
    let ends = [DVec3::splat(1e70), DVec3::splat(-1e70), DVec3::ZERO, DVec3::splat(1e-60), DVec3::X];
    let weights = [None, Some(vec![1e-100, 1.0]), Some(vec![1.0, 1e100]), Some(vec![1e-50, 1e50])];
    for a in ends {
        for b in ends.into_iter().filter(|b| *b != a) {
            for w in &weights {
                for z in &weights {
                    let (one, other) = (line(a, b, w.clone()), line(b, a, z.clone()));
                    let found = deviation(&one, &other);
                    assert!(found.proven.is_finite() && found.measured.is_finite() && found.measured <= found.proven);
                    assert!(found.proven >= a.distance(b) * (1.0 - 1e-12), "the ends are exchanged");
                }
            }
        }
    }
    // the highest degree, rational, with other knots
    let mut random = Random::new(19);
    let points: Vec<Vec<DVec3>> = (0..26).map(|_| (0..26).map(|_| random.in_cube()).collect()).collect();
    let weights: Vec<Vec<f64>> = (0..26).map(|_| (0..26).map(|_| random.power(-2.0, 2.0)).collect()).collect();
    let knots = || [vec![0.0; 26], vec![1.0; 26]].concat();
    let one = NurbsSurface::new((25, 25), (knots(), knots()), points, Some(weights)).expect("valid");
    let other = one.insert_knot(Direction::U, 0.3, 2).expect("valid");
    let found = deviation(&one.into(), &other.into());
    assert!(found.proven < 1e-9, "{found:?}");
}
