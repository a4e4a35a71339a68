//! The longest iso-curves of a surface (Piegl et al. 2008, §5).

use glam::DVec3;
use perpend_kernel::{Direction, NurbsCurve, NurbsSurface};

/// The net is refined until the longest extents change by less than this share: the net is then close to the surface.
const CHANGE: f64 = 0.02;

/// How often it is refined at most; each round halves every span, and a net's distance from the surface falls to a quarter.
const ROUNDS: u32 = 3;

/// A net with more points than this is not refined.
const MOST_POINTS: usize = 1 << 17;

/// The longest iso-curves, one along u and one along v; none where the surface has no extent in a direction.
pub(super) fn longest(surface: &NurbsSurface) -> [Option<NurbsCurve>; 2] {
    let refined = refined(surface);
    let lines = [lines(&refined, Direction::U), lines(&refined, Direction::V)];
    let iso = |along: usize, held: Direction| {
        let node = node(&refined, held, lines[along].0);
        surface.iso_curve(held, node).ok()
    };
    [iso(0, Direction::V), iso(1, Direction::U)]
}

/// The surface with a net whose longest extents are those of the surface, nearly.
fn refined(surface: &NurbsSurface) -> NurbsSurface {
    let extents = |surface: &NurbsSurface| [lines(surface, Direction::U).1, lines(surface, Direction::V).1];
    let mut fine = surface.clone();
    let mut before = extents(&fine);
    for _ in 0..ROUNDS {
        let middles = |direction| -> Vec<f64> {
            let inside = |u: &f64| !fine.knots(direction).distinct().any(|(knot, _)| knot == *u);
            fine.knots(direction)
                .spans()
                .map(|span| span.start + 0.5 * (span.end - span.start))
                .filter(inside)
                .collect()
        };
        let (u, v) = (middles(Direction::U), middles(Direction::V));
        if (fine.rows() + u.len()).saturating_mul(fine.columns() + v.len()) > MOST_POINTS {
            break;
        }
        let Ok(next) = fine.refine(Direction::U, &u).and_then(|fine| fine.refine(Direction::V, &v)) else { break };
        fine = next;
        let after = extents(&fine);
        let settled = (0..2).all(|k| before[k] - after[k] <= CHANGE * before[k]);
        before = after;
        if settled {
            break;
        }
    }
    fine
}

/// The longest line of the net along a direction: its index across, and its length.
fn lines(surface: &NurbsSurface, along: Direction) -> (usize, f64) {
    let (rows, columns) = (surface.rows(), surface.columns());
    let net = surface.control_points();
    let (count, others) = match along {
        Direction::U => (rows, columns),
        Direction::V => (columns, rows),
    };
    let at = |k: usize, other: usize| -> DVec3 {
        match along {
            Direction::U => net[k * columns + other],
            Direction::V => net[other * columns + k],
        }
    };
    let length = |other: usize| (1..count).map(|k| at(k - 1, other).distance(at(k, other))).sum::<f64>();
    (0..others)
        .map(|other| (other, length(other)))
        .fold((0, -1.0), |most, line| if line.1 > most.1 { line } else { most })
}

/// The parameter that belongs to a line of the net: its node, the mean of the knots that carry it.
fn node(surface: &NurbsSurface, held: Direction, line: usize) -> f64 {
    let knots = surface.knots(held);
    let degree = knots.degree();
    let carrying = &knots.as_slice()[line + 1..=line + degree];
    // shares first: the sum of huge knots may overflow
    knots.clamp(carrying.iter().map(|knot| knot / degree as f64).sum())
}
