//! Which direction of an arc about a centre is nearest.
//!
//! All points of a shape that is turned about a centre (an arc, or in the plane across its axis a surface of revolution) lie on rays from
//! it over a range of angles. A query within the range has its nearest point on its own ray; any other has it on the ray of the
//! nearer end, since the distance to a point at radius `r >= 0`, `r² + rho² - 2 r rho cos(turn)`, falls with the angle between the rays.
//!
//! Nothing here needs an angle: directions are unit vectors, and their order is a sign of a cross product.

use glam::DVec2;
use perpend_kernel::KnotVector;

use super::axes::ROUNDING;
use super::inverse::Inverse;
use crate::solver::Tie;

/// Directions from `-half` to `half` about the first coordinate, ascending with the parameter.
///
/// Coordinates are relative to a point at the distance `shift` from the centre, on the middle ray: the centre itself where the arc is
/// about as large as its radius, a point of the arc where the radius is much larger, so that nothing cancels.
#[derive(Debug)]
pub(super) struct Sector {
    shift: f64,
    /// Cosine and sine of half the range.
    end: DVec2,
    /// `1 - cos` of it.
    versine: f64,
    /// The largest distance between two of its points at radius 1.
    width: f64,
    /// A full turn.
    full: bool,
    inverse: Inverse,
}

/// The direction that is nearest to a query, and where the query is as seen along it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ray {
    pub direction: DVec2,
    /// The query's coordinate along the ray, less the shift.
    pub radial: f64,
    /// And across it.
    pub across: f64,
    /// The query from the centre, its second coordinate made positive, and that as it was.
    from: DVec2,
    y: f64,
    rho: f64,
    side: Side,
}

/// Where a query is beside a sector.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Within,
    Centre,
    Start,
    End,
}

/// How far the definition may begin or end from where its shape does, in radians.
const ENDS: f64 = 1e-6;

impl Sector {
    /// The sector of a range of angles about the middle, along which the control points of a definition lie, seen from the centre in units
    /// of some radius, with these weights.
    pub(super) fn new(
        turn: f64,
        shift: f64,
        knots: &KnotVector,
        net: impl Iterator<Item = (DVec2, f64)>,
    ) -> Option<Self> {
        let full = turn >= std::f64::consts::TAU * (1.0 - 4.0 * f64::EPSILON);
        let (sin, cos) = if full { (0.0, -1.0) } else { (0.5 * turn).sin_cos() };
        let versine = if full { 2.0 } else { 2.0 * (0.25 * turn).sin().powi(2) };
        let inverse = Inverse::new(knots, net.map(|(pair, w)| (pair * w, w)), true)?;
        let [first, last] = inverse.ends();
        let slack = ENDS * sin.max(0.25 * turn).min(1.0);
        let near = |pair: DVec2, sin: f64| pair.perp_dot(DVec2::new(cos, sin)).abs() <= slack * pair.length();
        let fits = near(first, -sin) && near(last, sin) && first.x * cos - first.y * sin > 0.0;
        let width = if cos > 0.0 { 2.0 * sin } else { 2.0 };
        fits.then_some(Self { shift, end: DVec2::new(cos, sin), versine, width, full, inverse })
    }

    #[inline]
    pub(super) fn shift(&self) -> f64 {
        self.shift
    }

    /// The nearest ray to a query; nearer than `noise` to the centre or to the middle between both ends, it counts as being there.
    #[inline(always)]
    pub(super) fn nearest(&self, q: DVec2, noise: f64) -> Ray {
        let (shift, DVec2 { x: cos, y: sin }) = (self.shift, self.end);
        let from = DVec2::new(q.x + shift, q.y.abs());
        let rho = from.length();
        if rho <= noise {
            let direction = DVec2::new(cos, -sin);
            return Ray { direction, radial: rho - shift, across: 0.0, from, y: q.y, rho, side: Side::Centre };
        }
        if !self.full && from.y * cos > from.x * sin {
            let (sin, side) = if q.y <= noise { (-sin, Side::Start) } else { (sin, Side::End) };
            let radial = q.x * cos + q.y * sin - shift * self.versine;
            let across = q.y * cos - q.x * sin - shift * sin;
            return Ray { direction: DVec2::new(cos, sin), radial, across, from, y: q.y, rho, side };
        }
        let radial = if shift == 0.0 { rho } else { (q.x * (q.x + 2.0 * shift) + q.y * q.y) / (rho + shift) };
        let inverse = 1.0 / rho;
        let direction = DVec2::new(from.x * inverse, q.y * inverse);
        Ray { direction, radial, across: 0.0, from, y: q.y, rho, side: Side::Within }
    }

    /// The definition's parameter on a ray; the lowest of those that share a point.
    ///
    /// `reach` is how far the query is: its rounding, turned by the bend of the shape between it and the foot, is what a border of a piece is
    /// met within.
    #[inline(always)]
    pub(super) fn parameter(&self, ray: &Ray, reach: f64) -> f64 {
        let (first, last) = self.inverse.domain();
        let parameter = match ray.side {
            Side::Centre | Side::Start => first,
            Side::End => last,
            Side::Within => {
                let (rounding, most) = (8.0 * ROUNDING * (1.0 + reach), 1e-9 * ray.rho);
                let tolerance = if rounding < most { rounding } else { most };
                self.inverse.parameter(ray.from.x, ray.y, tolerance)
            }
        };
        if self.full && parameter == last { first } else { parameter }
    }

    /// The lowest parameter.
    #[inline]
    pub(super) fn first(&self) -> f64 {
        self.inverse.domain().0
    }

    /// What other directions are to a foot at `radius` from the centre and `distance` from the query.
    ///
    /// On a direction that is turned away by an angle, the square of the distance is larger by `2 radius rho (1 - cos)`.
    #[inline(always)]
    pub(super) fn tie(&self, ray: &Ray, radius: f64, distance: f64, asked: &Asked) -> Tie {
        let DVec2 { x: cos, y: sin } = self.end;
        let excess = asked.gap * (2.0 * distance + asked.gap);
        // no direction is nearer than 1 - cos = rho less its own coordinate along the end
        if radius * self.width <= asked.coincidence {
            return Tie::None;
        }
        let of = |more: f64| 2.0 * radius * more <= excess;
        if of(2.0 * ray.rho) {
            return Tie::Connected;
        }
        let to_far_end = ray.rho - (ray.from.x * cos - ray.from.y * sin);
        match ray.side {
            Side::Centre => Tie::None,
            Side::Start | Side::End => {
                let other = 2.0 * ray.from.y * sin;
                if of(other) && 2.0 * radius * sin > asked.coincidence { Tie::Apart } else { Tie::None }
            }
            Side::Within if self.full || !of(to_far_end) => Tie::None,
            // beyond half a turn from the ray the distance falls again towards the far end
            Side::Within if ray.from.y * cos + ray.from.x * sin < 0.0 => {
                let apart = radius * (2.0 * to_far_end.max(0.0) / ray.rho).sqrt() > asked.coincidence;
                if apart { Tie::Apart } else { Tie::None }
            }
            Side::Within => Tie::Connected,
        }
    }
}

/// What is asked of a foot, in local lengths.
#[derive(Debug, Clone, Copy)]
pub(super) struct Asked {
    /// Feet that are farther by no more than this tie.
    pub gap: f64,
    /// Feet farther from one another than this are different ones.
    pub coincidence: f64,
    /// How far rounding in the model may have moved the query.
    pub noise: f64,
    /// How far the query is from the origin.
    pub reach: f64,
}
