//! The squared gradient in Bernstein form (Xu et al. 2014), and all stationary points from the gradient's own form.
//!
//! The paper searches the zeros of `w = (∂D/∂u)² + (∂D/∂v)²`, `D` the squared distance, on polynomial patches, in their interior: a quadtree by de
//! Casteljau's algorithm drops boxes on which all coefficients of `w` are positive. [`propose`] does that, on rational pieces, creases and edges too.
//!
//! A square never changes its sign, so that `w` can exclude boxes and prove no zero. [`isolate`] keeps both derivatives apart: excluded is by the sign of
//! either or of a combination, and zeros are proven one by one.
//!
//! [`patch`] makes the [`polynomial`]s, [`strata`] says where the entity has edges and creases, [`gather`] joins what pieces and edges found.

mod gather;
mod isolate;
mod patch;
mod polynomial;
mod propose;
mod strata;

use glam::DVec3;
use perpend_kernel::{Definition, cartesian};

use self::patch::{Common, Patch, patches};
use self::strata::{Line, lines};
use crate::hierarchy::Frame;
use crate::landmarks::Landmarks;
use crate::stationary::{Certainty, Extremum};

/// An entity's pieces, and the lines between them.
#[derive(Debug)]
pub(crate) struct Bernstein {
    frame: Frame,
    common: Common,
    /// Rows along u, each with `columns` pieces along v.
    patches: Vec<Patch>,
    columns: usize,
    /// Edges, seams and creases: lines of constant u, and of constant v.
    lines: [Vec<Line>; 2],
    closed: [bool; 2],
    domain: [(f64, f64); 2],
    is_curve: bool,
}

/// A stationary point in the entity's own coordinates.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LocalPoint {
    pub at: [f64; 2],
    pub range: [(f64, f64); 2],
    /// In the entity's coordinates.
    pub point: DVec3,
    pub kind: Option<Extremum>,
    pub descends_inward: bool,
    pub certainty: Certainty,
}

/// All stationary points, and the sets of boxes that are none.
#[derive(Debug)]
pub(crate) struct LocalSet {
    pub points: Vec<LocalPoint>,
    pub continua: Vec<Vec<[(f64, f64); 2]>>,
    pub complete: bool,
}

impl Bernstein {
    pub(crate) fn new(definition: &Definition, landmarks: &Landmarks) -> Self {
        let frame = Frame::of(definition);
        let (net, rational) = frame.net(definition);
        let reach = net.iter().fold(0.0_f64, |r, h| r.max(cartesian(*h).length()));
        let (degree, is_curve) = match definition {
            Definition::NurbsCurve(curve) => ((curve.degree(), 0), true),
            Definition::NurbsSurface(surface) => (surface.degree(), false),
        };
        let (patches, columns) = patches(definition, &net, landmarks.poles);
        let rows = patches.len() / columns;
        let (first, last) = (&patches[0], &patches[patches.len() - 1]);
        let domain = [(first.u.0, last.u.1), (first.v.0, last.v.1)];
        let knots: [Vec<f64>; 2] = [
            patches.iter().step_by(columns).map(|patch| patch.u.0).collect(),
            patches[..columns].iter().map(|patch| patch.v.0).collect(),
        ];
        let along = |d: usize| lines(&knots[d], landmarks, d);
        let lines = [along(0), if is_curve { Vec::new() } else { along(1) }];
        debug_assert_eq!(knots[0].len(), rows, "the pieces are a grid");
        Self {
            frame,
            common: Common::new(degree, rational, reach),
            patches,
            columns,
            lines,
            closed: landmarks.closed,
            domain,
            is_curve,
        }
    }

    /// The frame of the entity's own coordinates.
    pub(crate) fn frame(&self) -> &Frame {
        &self.frame
    }

    fn patch(&self, row: usize, column: usize) -> (usize, &Patch) {
        let index = row * self.columns + column;
        (index, &self.patches[index])
    }
}
