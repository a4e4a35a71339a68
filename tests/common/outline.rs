//! The outline of a trimmed face in the parameter plane, by its own means: every p-curve is cut into chords, and each chord knows how far the curve may stray
//! from it (its Bézier points lie in the capsule of that radius around the chord). A point outside a chord's capsule sees chord and curve alike, so
//! crossings of straight chords are counted; inside, the chord is halved. Nothing of the kernel's regions is used but the p-curves.
//!
//! Parameters are measured as shares of the carrier's domain.

use glam::{DVec2, DVec3};
use perpend_kernel::{Direction, NurbsSurface, PlaneCurve, TrimLoop};

/// What rounding may do to a share of the domain.
const ROUNDING: f64 = 4e-15;

/// A chord is cut until the curve strays from it by no more than this share of the outline's extent.
const FLATNESS: f64 = 1e-4;

/// Where parameters lie, seen from an outline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    Inside,
    Outside,
    /// On the outline, or nearer to it than rounding.
    Beside,
}

/// A part of a p-curve, or the straight way over a gap between two.
#[derive(Debug, Clone)]
pub struct Chord {
    /// Bézier points in shares of the domain, homogeneous.
    net: Vec<DVec3>,
    from: DVec2,
    to: DVec2,
    stray: f64,
    /// Which curve of which loop; none: a gap.
    of: Option<(usize, usize)>,
    /// The parameters of the curve; of a gap, shares.
    pub range: [f64; 2],
}

impl Chord {
    fn new(net: Vec<DVec3>, from: DVec2, to: DVec2, of: Option<(usize, usize)>, range: [f64; 2]) -> Self {
        let inner = net.iter().skip(1).take(net.len().saturating_sub(2));
        let stray = inner.map(|h| to_segment(h.truncate() / h.z, from, to)).fold(0.0, f64::max);
        Self { net, from, to, stray, of, range }
    }

    fn halves(&self) -> [Self; 2] {
        let (mut low, mut high, mut work) = (Vec::new(), Vec::new(), self.net.clone());
        while let (Some(first), Some(last)) = (work.first(), work.last()) {
            low.push(*first);
            high.push(*last);
            work = work.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
        }
        high.reverse();
        let tip = high[0].truncate() / high[0].z;
        let middle = 0.5 * (self.range[0] + self.range[1]);
        [
            Self::new(low, self.from, tip, self.of, [self.range[0], middle]),
            Self::new(high, tip, self.to, self.of, [middle, self.range[1]]),
        ]
    }

    /// Whether the ray from `q` towards larger u crosses the chord.
    fn crosses(&self, q: DVec2) -> bool {
        let (a, b) = (self.from, self.to);
        (a.y > q.y) != (b.y > q.y) && ((b - a).perp_dot(q - a) > 0.0) == (b.y > a.y)
    }

    /// Counts crossings of the curve; none where `q` lies on it as far as can be told.
    fn count(&self, q: DVec2) -> Option<usize> {
        let reach = self.stray + ROUNDING;
        let (low, high) = (self.from.min(self.to), self.from.max(self.to));
        if q.y < low.y - reach || q.y > high.y + reach || q.x > high.x + reach {
            return Some(0);
        }
        if q.x < low.x - reach || to_segment(q, self.from, self.to) > reach {
            return Some(usize::from(self.crosses(q)));
        }
        if self.stray <= ROUNDING {
            return None;
        }
        let [a, b] = self.halves();
        Some(a.count(q)? + b.count(q)?)
    }

    /// The distance of `q` to the curve to a millionth of it, where it is less than `best`.
    fn nearer(&self, q: DVec2, best: f64) -> f64 {
        let apart = to_segment(q, self.from, self.to);
        if apart - self.stray >= (1.0 - 1e-6) * best {
            return best;
        }
        if self.stray <= ROUNDING.max(1e-7 * apart) {
            return best.min(apart);
        }
        let [a, b] = self.halves();
        b.nearer(q, a.nearer(q, best))
    }
}

fn to_segment(q: DVec2, a: DVec2, b: DVec2) -> f64 {
    let way = b - a;
    let length = way.length_squared();
    let share = if length > 0.0 { ((q - a).dot(way) / length).clamp(0.0, 1.0) } else { 0.0 };
    q.distance(a + share * way)
}

/// The outline of a face: closed loops of chords.
#[derive(Debug, Clone)]
pub struct Outline {
    origin: DVec2,
    extent: DVec2,
    /// Loop by loop, in order, each chord from the end of the one before it.
    pub loops: Vec<Vec<Chord>>,
    curves: Vec<Vec<PlaneCurve>>,
}

impl Outline {
    pub fn new(surface: &NurbsSurface, loops: &[TrimLoop]) -> Self {
        let [(u0, u1), (v0, v1)] = [Direction::U, Direction::V].map(|direction| surface.domain(direction));
        let origin = DVec2::new(u0, v0);
        let extent = DVec2::new(u1, v1) - origin;
        let curves: Vec<Vec<PlaneCurve>> =
            loops.iter().map(|one| one.curves.iter().map(|trim| trim.curve.clone()).collect()).collect();
        let mut outline = Self { origin, extent, loops: Vec::new(), curves };
        let all = outline.curves.iter().flatten().flat_map(PlaneCurve::points);
        let none = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (low, high) = all.map(|uv| outline.share(uv)).fold(none, |(low, high), q| (low.min(q), high.max(q)));
        let flat = FLATNESS * (high - low).max_element();
        outline.loops = (0..loops.len()).map(|of| outline.chords(of, flat)).collect();
        outline
    }

    fn chords(&self, of: usize, flat: f64) -> Vec<Chord> {
        let curves = &self.curves[of];
        let mut chords: Vec<Chord> = Vec::new();
        let mut at = self.share(curves[curves.len() - 1].end());
        for (index, curve) in curves.iter().enumerate() {
            let start = self.share(curve.start());
            if at != start {
                chords.push(Chord::new(vec![at.extend(1.0), start.extend(1.0)], at, start, None, [0.0, 1.0]));
                at = start;
            }
            let pieces = curve.pieces();
            let last = pieces.len() - 1;
            for ((k, piece), span) in pieces.iter().enumerate().zip(curve.knots().spans()) {
                let share = |h: &glam::DVec4| {
                    let q = (DVec2::new(h.x, h.y) - h.w * self.origin) / self.extent;
                    q.extend(h.w)
                };
                let net: Vec<DVec3> = piece.points.iter().map(share).collect();
                let tip = net[net.len() - 1];
                let end = if k == last { self.share(curve.end()) } else { tip.truncate() / tip.z };
                let whole = Chord::new(net, at, end, Some((of, index)), [span.start, span.end]);
                at = end;
                flattened(whole, flat, 10, &mut chords);
            }
        }
        chords
    }

    /// Parameters as shares of the domain.
    pub fn share(&self, uv: DVec2) -> DVec2 {
        (uv - self.origin) / self.extent
    }

    pub fn side(&self, uv: DVec2) -> Verdict {
        let q = self.share(uv);
        let mut crossings = 0;
        for chord in self.loops.iter().flatten() {
            match chord.count(q) {
                Some(count) => crossings += count,
                None => return Verdict::Beside,
            }
        }
        if crossings % 2 == 1 { Verdict::Inside } else { Verdict::Outside }
    }

    /// How far parameters lie from the outline, in shares of the domain.
    pub fn distance(&self, uv: DVec2) -> f64 {
        let q = self.share(uv);
        self.loops.iter().flatten().fold(f64::INFINITY, |best, chord| chord.nearer(q, best))
    }

    /// How far parameters lie from the nearest end of a p-curve, in shares of the domain.
    pub fn distance_to_ends(&self, uv: DVec2) -> f64 {
        let q = self.share(uv);
        let ends = self.curves.iter().flatten().flat_map(|curve| [curve.start(), curve.end()]);
        ends.map(|end| self.share(end).distance(q)).fold(f64::INFINITY, f64::min)
    }

    /// The parameters of the surface at a share `s` of a chord of a loop.
    pub fn at(&self, chord: &Chord, s: f64) -> DVec2 {
        let [first, last] = chord.range;
        let t = if s >= 1.0 { last } else { first + s * (last - first) };
        match chord.of {
            Some((of, curve)) => self.curves[of][curve].point(t),
            None => self.origin + self.extent * chord.from.lerp(chord.to, t),
        }
    }

    /// The least and the largest parameters of the chords' ends, widened by what curves stray.
    pub fn bounds(&self) -> (DVec2, DVec2) {
        let none = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (low, high) = self.loops.iter().flatten().fold(none, |(low, high), chord| {
            let (from, to, stray) = (chord.from, chord.to, DVec2::splat(chord.stray));
            (low.min(from.min(to) - stray), high.max(from.max(to) + stray))
        });
        let (low, high) = (low.max(DVec2::ZERO), high.min(DVec2::ONE));
        (self.origin + self.extent * low, self.origin + self.extent * high)
    }
}

fn flattened(chord: Chord, flat: f64, depth: u32, out: &mut Vec<Chord>) {
    if chord.stray <= flat || depth == 0 {
        out.push(chord);
    } else {
        chord.halves().into_iter().for_each(|half| flattened(half, flat, depth - 1, out));
    }
}
