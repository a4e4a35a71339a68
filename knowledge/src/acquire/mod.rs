//! What a definition tells of itself: the representation part of its record.
//!
//! Speeds, box, arc length, continuity and most irregularities come with proven bounds; what was computed without proof says
//! so ([`Basis::Measured`]). Work is bounded whatever the definition: where a bound stops it, gaps are wider, and what could
//! not be settled is not listed.

mod bernstein;
mod continuity;
mod ends;
mod fill;
mod found;
mod jets;
mod joints;
mod knots;
mod loops;
mod measure;
mod near;
mod normals;
mod open;
mod options;
mod source;
mod speed;
mod stops;
mod tight;
mod turning;
mod two_level;
mod zeros;

use perpend_kernel::{Definition, Direction, Fingerprint};

pub(crate) use measure::enclosure;
pub use options::AcquireOptions;

use crate::category::Categories;
use crate::finite;
use crate::item::{Basis, Item};
use crate::representation::{Break, Irregularity, ParameterPoint, Representation, SpanSpeed, Speed};
use found::proved;
use joints::Joints;
use source::Source;

/// Acquires the representation of a definition, all of it but what was done on entry.
///
/// The work is about proportional to the number of control points, for a given degree; see [`AcquireOptions::work`].
///
/// ```
/// use perpend_kernel::{Circle, Definition, Frame};
/// use perpend_knowledge::{AcquireOptions, acquire};
/// use std::f64::consts::{SQRT_2, TAU};
///
/// let rim: Definition = Circle::new(Frame::WORLD, 2.0, (0.0, TAU))?.to_nurbs()?.into();
/// let known = acquire(&rim, &AcquireOptions::default());
/// let speed = &known.speed.as_ref().expect("acquired")[0].value;
/// assert!((speed.factor - (0.5 - SQRT_2 / 4.0)).abs() < 1e-8);
/// assert_eq!(speed.category.as_ref().map(|c| c.name.as_str()), Some("nearly uniform"));
/// assert_eq!(known.periodic.map(|item| item.value), Some((true, false)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn acquire(definition: &Definition, options: &AcquireOptions) -> Representation {
    let of = definition.fingerprint();
    let size = definition.size();
    let same = options.coincidence * size;
    let source = Source::of(definition);
    let sources: Vec<(Direction, Source)> = match definition {
        Definition::NurbsCurve(_) => vec![(Direction::U, source)],
        Definition::NurbsSurface(_) => {
            let turned = source.turned();
            vec![(Direction::U, source), (Direction::V, turned)]
        }
    };
    let ranges: Vec<(Direction, Vec<speed::Range>)> =
        sources.iter().map(|(direction, source)| (*direction, speed::ranges(source, options.work as f64))).collect();
    let joints: Vec<Joints> =
        sources.iter().map(|(direction, source)| joints::of(definition, *direction, source, options)).collect();
    let poles = ends::poles(definition, same);
    let (mut breaks, mut irregularities, mut closed) = (Vec::new(), Vec::new(), [Closure::default(); 2]);
    for pole in &poles {
        let value = Irregularity::Pole { direction: pole.direction, at: pole.at, extent: pole.extent };
        irregularities.push(proved(value, pole.extent, same));
    }
    for (joints, closure) in joints.iter().zip(&mut closed) {
        let sound = joints.breaks.iter().filter(|(value, ..)| finite::check(value).is_ok());
        breaks.extend(sound.map(|found| item(found, of)));
        irregularities.extend(joints.irregularities.iter().copied());
        *closure = Closure { gap: joints.gap, is_closed: joints.is_closed, is_periodic: joints.is_periodic };
    }
    for (direction, source) in &sources {
        let near = knots::near(source, *direction, options);
        irregularities.extend(near.into_iter().map(|value| proved(value, 4.0 * f64::EPSILON, options.near_knots)));
    }
    let (bounds, gap) = tight::bounds(&sources[0].1);
    let weights = definition.weights().unwrap_or(&[1.0]);
    let (lightest, heaviest) =
        weights.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), w| (low.min(*w), high.max(*w)));
    let gaps = closed.iter().filter(|c| c.is_closed).map(|c| c.gap).fold(0.0, f64::max);
    let mut part = Representation {
        speed: Some(ranges.iter().map(|(of, ranges)| speeds(*of, ranges, definition, &options.categories)).collect()),
        breaks: Some(breaks),
        closed: Some(item(&((closed[0].is_closed, closed[1].is_closed), Basis::Proved { gap: gaps }, same), of)),
        periodic: Some(item(
            &((closed[0].is_periodic, closed[1].is_periodic), Basis::Proved { gap: gaps }, options.continuity),
            of,
        )),
        bounds: Some(item(&(bounds, Basis::Proved { gap }, gap), of)),
        weights: Some(item(&((lightest, heaviest), Basis::Proved { gap: 0.0 }, 0.0), of)),
        ..Representation::default()
    };
    match definition {
        Definition::NurbsCurve(curve) => {
            let source = &sources[0].1;
            irregularities.extend(turning::irregular(source, size, &joints[0].creases, options));
            let loss = 64.0 * (curve.degree() + 4) as f64 * f64::EPSILON * definition.reach();
            let loops = loops::loops(curve, source, same);
            irregularities.extend(loops.into_iter().map(|value| proved(value, loss, same)));
            let (value, gap) = measure::length(curve, source);
            part.length = Some(item(&(limited(value), Basis::Proved { gap }, gap), of));
        }
        Definition::NurbsSurface(surface) => {
            irregularities.extend(stops::of(surface, &sources, &ranges, &poles, options));
            irregularities.extend(normals::irregular(surface, &sources[0].1, &poles, options));
            let (value, error) = measure::area(surface);
            part.area = Some(item(&(limited(value), Basis::Measured { error }, error), of));
        }
    }
    // what overflowed, of extreme weights, tells nothing
    irregularities.retain(|(value, ..)| finite::check(value).is_ok());
    part.irregularities = Some(irregularities.iter().map(|found| item(found, of)).collect());
    part
}

/// The parametrisation factor of a direction by the estimate of Piegl et al. 2008, §5: two levels of refinement of the derivative.
///
/// Not below the factor itself, which [`acquire`] gives with a proof; this is for comparison with the paper. A curve has the
/// direction U alone, and gives its factor for V too.
#[must_use]
pub fn two_level_estimate(definition: &Definition, direction: Direction) -> f64 {
    let source = Source::of(definition);
    two_level::estimate(&if direction == Direction::V { source.turned() } else { source })
}

/// What is known of the ends of one direction.
#[derive(Debug, Clone, Copy, Default)]
struct Closure {
    gap: f64,
    is_closed: bool,
    is_periodic: bool,
}

fn item<T: Clone>((value, basis, tolerance): &(T, Basis, f64), of: Fingerprint) -> Item<T> {
    let basis = match *basis {
        Basis::Proved { gap } => Basis::Proved { gap: limited(gap) },
        Basis::Measured { error } => Basis::Measured { error: limited(error) },
        other => other,
    };
    Item { value: value.clone(), basis, tolerance: limited(*tolerance), of }
}

/// Numbers of a record are finite; a bound of extreme data may overflow.
fn limited(x: f64) -> f64 {
    if x.is_nan() { f64::MAX } else { x.clamp(f64::MIN, f64::MAX) }
}

/// The other direction of a surface.
fn other(direction: Direction) -> Direction {
    match direction {
        Direction::U => Direction::V,
        Direction::V => Direction::U,
    }
}

/// `(max - min) / max`.
fn factor(min: f64, max: f64) -> f64 {
    if max > 0.0 { (max - min) / max } else { 1.0 }
}

fn place(is_curve: bool, direction: Direction, (s, t): (f64, f64)) -> ParameterPoint {
    match (is_curve, direction) {
        (true, _) => ParameterPoint::Curve(s),
        (false, Direction::U) => ParameterPoint::Surface(s, t),
        (false, Direction::V) => ParameterPoint::Surface(t, s),
    }
}

fn speeds(
    direction: Direction,
    ranges: &[speed::Range],
    definition: &Definition,
    categories: &Categories,
) -> Item<Speed> {
    let span = |range: &speed::Range| {
        let (min, max) = (limited(range.least.bound), limited(range.greatest.bound));
        SpanSpeed { from: range.from, to: range.to, min, max, factor: factor(min, max) }
    };
    let spans: Vec<SpanSpeed> = ranges.iter().map(span).collect();
    let least = ranges.iter().map(|r| r.least).min_by(|a, b| a.attained.total_cmp(&b.attained));
    let greatest = ranges.iter().map(|r| r.greatest).max_by(|a, b| a.attained.total_cmp(&b.attained));
    let (least, greatest) = least.zip(greatest).expect("a definition has a span");
    let min = spans.iter().map(|s| s.min).fold(f64::INFINITY, f64::min);
    let max = spans.iter().map(|s| s.max).fold(0.0, f64::max);
    // the attained values are evaluated, which their bounds allow for
    let gap = (least.attained - min).max(max - greatest.attained).max(0.0);
    let factor = factor(min, max);
    let is_curve = matches!(definition, Definition::NurbsCurve(_));
    let value = Speed {
        direction,
        min,
        max,
        factor,
        min_at: Some(place(is_curve, direction, least.at)),
        max_at: Some(place(is_curve, direction, greatest.at)),
        category: Some(categories.of(factor).clone()),
        spans,
    };
    item(&(value, Basis::Proved { gap }, gap), definition.fingerprint())
}
