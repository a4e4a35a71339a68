//! Query points that are hard on purpose, for a given entity.

use glam::DVec3;

use super::adversaries::Adversary;
use super::double_double::Dd;
use super::random::Random;
use super::shape::Shape;

/// A point of an entity with its frame, by differences of the exact evaluation.
pub struct Place {
    pub point: DVec3,
    pub u: DVec3,
    pub v: DVec3,
    /// A unit normal; on a curve any, by chance the principal one. Zero where none was found.
    pub normal: DVec3,
    /// The curvature along u in that normal's direction: `1 / radius`, signed.
    pub curvature: f64,
}

/// The place at a parameter of the domain.
pub fn place(shape: &Shape, at: [f64; 2], random: &mut Random) -> Place {
    let point = shape.point(at[0], at[1]);
    // derivatives by central differences of 30 digits, a step inside the domain
    let steps = [0, 1].map(|k| {
        let [first, last] = shape.domain(k);
        1e-7 * (last - first)
    });
    let centre = [0, 1].map(|k| {
        let [first, last] = shape.domain(k);
        at[k].clamp(first + steps[k], last - steps[k])
    });
    let seen = |du: f64, dv: f64| {
        let at = [0, 1].map(|k| Dd::from(centre[k]) + Dd::product([du, dv][k], steps[k]));
        let [x, y, z] = shape.seen_from(point, at[0], at[1]);
        DVec3::new(x.value(), y.value(), z.value())
    };
    let (before, middle, after) = (seen(-1.0, 0.0), seen(0.0, 0.0), seen(1.0, 0.0));
    let u = (after - before) / 2.0;
    let uu = after - 2.0 * middle + before;
    let v = if shape.curve { DVec3::ZERO } else { (seen(0.0, 1.0) - seen(0.0, -1.0)) / 2.0 };
    let normal = if shape.curve {
        let aside = if random.chance(0.5) { uu } else { random.direction() };
        (aside - u * (aside.dot(u) / u.length_squared())).normalize_or_zero()
    } else {
        u.cross(v).normalize_or_zero()
    };
    let curvature = uu.dot(normal) / u.length_squared();
    Place { point, u: u.normalize_or_zero(), v: v.normalize_or_zero(), normal, curvature }
}

/// A parameter of the domain: anywhere, at a knot, at an end.
pub fn parameter(shape: &Shape, along: usize, random: &mut Random) -> f64 {
    let [first, last] = shape.domain(along);
    match random.count(0, 9) {
        0 => first,
        1 => last,
        2 => random.pick(&shape.knots[along]),
        3 => {
            // within a random span, so that short ones are met
            let span = random.pick(&shape.spans(along));
            let knots = &shape.knots[along];
            random.between(knots[span], knots[span + 1])
        }
        4 => 0.5 * (first + last),
        _ => random.between(first, last),
    }
}

/// About `count` query points for an adversary, of all kinds.
pub fn hard_points(adversary: &Adversary, count: usize, random: &mut Random) -> Vec<DVec3> {
    let shape = &adversary.shape;
    let size = shape.size();
    let [low, high] = shape.bounds();
    let middle = 0.5 * (low + high);
    let mut points = Vec::with_capacity(count + 16);
    while points.len() < count {
        let at = [0, 1].map(|k| parameter(shape, k, random));
        let place = place(shape, at, random);
        let side = |distance: f64| place.point + distance * place.normal;
        let tiny = size * random.power(-12.0, -5.0);
        // on it; very near, near and at middling distance, on both sides
        points.extend([place.point, side(tiny), side(-tiny)]);
        points.push(side(random.sign() * size * random.power(-5.0, -2.0)));
        points.push(side(random.sign() * size * random.power(-2.0, 0.3)));
        // the centre of curvature, and beside it
        if place.curvature.abs() * size > 1e-3 && place.curvature.is_finite() {
            let centre = side(1.0 / place.curvature);
            points.extend([centre, centre + size * random.power(-12.0, -4.0) * random.direction()]);
        }
        // what belongs to the entity: centres, axes, spines
        if !adversary.special.is_empty() {
            let special = random.pick(&adversary.special);
            points.extend([special, special + size * random.power(-12.0, -4.0) * random.direction()]);
        }
        // beyond an end or a corner
        let end = [0, 1].map(|k| random.pick(&shape.domain(k)));
        let corner = self::place(shape, end, random);
        let outward = random.sign() * corner.u + random.sign() * corner.v + random.between(-1.0, 1.0) * corner.normal;
        points.push(corner.point + size * random.power(-8.0, 1.0) * outward);
        // on and beside control points, between two points of the entity, in the middle of all
        let control = random.pick(&shape.points);
        let other = random.pick(&shape.points);
        points.extend([control, 0.5 * (control + other)]);
        let second = [0, 1].map(|k| parameter(shape, k, random));
        points.push(0.5 * (place.point + shape.point(second[0], second[1])));
        if random.chance(0.3) {
            points.push(middle);
        }
        // around and far away
        points.push(middle + 1.5 * size * random.in_cube());
        points.push(middle + size * random.power(0.5, 3.0) * random.direction());
    }
    points.truncate(count);
    points
}
