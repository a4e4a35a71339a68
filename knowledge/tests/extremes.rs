//! What is acquired of extreme definitions is finite, and is not contradicted by what loading looks at.

use perpend_kernel::glam::DVec3;
use perpend_kernel::{CurveData, Definition, DefinitionData, SurfaceData};
use perpend_knowledge::{AcquireOptions, Record, acquire};

/// A generator of its own (splitmix64): the same numbers everywhere.
struct Numbers(u64);

impl Numbers {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    fn below(&mut self, count: u64) -> usize {
        (self.bits() % count) as usize
    }

    fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Plain, coincident, tiny and huge coordinates.
    fn coordinate(&mut self, scale: f64) -> f64 {
        match self.below(6) {
            0 => 0.0,
            1 => scale,
            2 => scale * 1e-12 * self.unit(),
            _ => scale * (2.0 * self.unit() - 1.0),
        }
    }

    fn weight(&mut self, spread: i32) -> f64 {
        10.0_f64.powi(self.below(2 * spread as u64 + 1) as i32 - spread) * (0.5 + self.unit())
    }

    /// Knots with repetitions and with very short spans.
    fn knots(&mut self, degree: usize, points: usize) -> Vec<f64> {
        let mut knots = vec![0.0; degree + 1];
        let mut at = 0.0;
        let mut times = degree;
        for _ in 0..points - degree - 1 {
            let step = [0.0, 1e-9, 0.25, 1.0][self.below(4)];
            let step = if step == 0.0 && (at == 0.0 || times >= degree) { 0.5 } else { step };
            times = if step == 0.0 { times + 1 } else { 1 };
            at += step;
            knots.push(at);
        }
        knots.extend(vec![at + 1.0; degree + 1]);
        knots
    }

    fn definition(&mut self) -> Option<Definition> {
        let scale = [1.0, 1e-60, 1e60, 1e3][self.below(4)];
        let spread = [0, 1, 10, 40][self.below(4)];
        let degree = |n: &mut Self| [1, 2, 3, 7][n.below(4)];
        let (p, q) = (degree(self), degree(self));
        let (rows, columns) = (p + 1 + self.below(4), q + 1 + self.below(4));
        let offset = if self.below(4) == 0 { 1e6 * scale } else { 0.0 };
        let point = |n: &mut Self| DVec3::new(n.coordinate(scale) + offset, n.coordinate(scale), n.coordinate(scale));
        let data: DefinitionData = if self.below(2) == 0 {
            let control_points = (0..rows).map(|_| point(self)).collect();
            let weights = (spread > 0).then(|| (0..rows).map(|_| self.weight(spread)).collect());
            DefinitionData::NurbsCurve(CurveData { degree: p, knots: self.knots(p, rows), control_points, weights })
        } else {
            let net = (0..rows).map(|_| (0..columns).map(|_| point(self)).collect()).collect();
            let row = |n: &mut Self| (0..columns).map(|_| n.weight(spread)).collect();
            let weights = (spread > 0).then(|| (0..rows).map(|_| row(self)).collect());
            let knots = (self.knots(p, rows), self.knots(q, columns));
            DefinitionData::NurbsSurface(SurfaceData { degree: (p, q), knots, control_points: net, weights })
        };
        data.enter().ok().map(|(definition, _)| definition)
    }
}

#[test]
fn what_is_acquired_is_finite_and_not_contradicted() {
    let mut numbers = Numbers(7);
    let options = AcquireOptions { work: 2_000_000, ..AcquireOptions::default() };
    let mut looked = 0;
    for round in 0..200 {
        let Some(definition) = numbers.definition() else { continue };
        looked += 1;
        let part = acquire(&definition, &options);
        let record = Record { representation: Some(part), ..Record::default() };
        assert_eq!(record.validate(), Ok(()), "{round}: {definition:?}");
        assert_eq!(record.contradictions(&definition), [], "{round}: {definition:?}");
    }
    assert!(looked > 150, "{looked}");
}
