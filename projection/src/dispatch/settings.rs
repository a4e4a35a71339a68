//! The settings: from the representation part of the record.

use perpend_kernel::{Definition, Fingerprint};
use perpend_knowledge::{Categories, Category, Irregularity, Item, ParameterPoint, Record, Representation, Speed};

use crate::landmarks::Landmarks;
use crate::plan::{Decomposition, Reason, Settings};

/// The settings of a definition's solvers, with their reasons.
pub(super) fn settings(
    definition: &Definition,
    record: Option<&Record>,
    landmarks: &Landmarks,
    gap: f64,
    reasons: &mut Vec<Reason>,
) -> Settings {
    let Some(part) = record.and_then(|record| record.representation.as_ref()) else {
        reasons.push(Reason {
            item: "representation".to_owned(),
            basis: None,
            effect: "not known; no solver of this plan needs it".to_owned(),
        });
        return Settings { gap, cuts: landmarks.cusps.clone(), decomposition: Vec::new() };
    };
    let of = definition.fingerprint();
    let cuts = cuts(definition, part, landmarks, of, reasons);
    breaks(part, of, reasons);
    closed(part, of, reasons);
    Settings { gap, cuts, decomposition: decomposition(part, of, reasons) }
}

/// The items of a list that belong to this definition, with the name of each.
fn fresh<'a, T>(
    items: Option<&'a Vec<Item<T>>>,
    name: &'static str,
    of: Fingerprint,
) -> impl Iterator<Item = (String, &'a Item<T>)> {
    let items = items.map_or(&[][..], Vec::as_slice).iter().enumerate();
    items
        .filter(move |(_, item)| !item.is_stale(of))
        .map(move |(k, item)| (format!("representation.{name}[{k}]"), item))
}

/// Where a curve's pieces are cut beside its knots: at the cusps that preparation finds itself, and at the cusps and loops of the record.
///
/// A cut in a wrong place costs work and changes no proof.
fn cuts(
    definition: &Definition,
    part: &Representation,
    landmarks: &Landmarks,
    of: Fingerprint,
    reasons: &mut Vec<Reason>,
) -> Vec<f64> {
    let mut cuts = landmarks.cusps.clone();
    let Definition::NurbsCurve(curve) = definition else { return cuts };
    let (first, last) = curve.domain();
    for (item, irregularity) in fresh(part.irregularities.as_ref(), "irregularities", of) {
        let found: Vec<f64> = match irregularity.value {
            Irregularity::Cusp { at: ParameterPoint::Curve(u), .. } => vec![u],
            Irregularity::Loop { from, to, .. } => vec![from, to],
            _ => continue,
        };
        let inner: Vec<f64> = found.into_iter().filter(|u| *u > first && *u < last).collect();
        if !inner.is_empty() {
            let places: Vec<String> = inner.iter().map(|u| format!("{u}")).collect();
            let effect =
                format!("the pieces are cut at u = {}, so that none turns back or meets itself", places.join(" and "));
            reasons.push(Reason { item, basis: Some(irregularity.basis), effect });
            cuts.extend(inner);
        }
    }
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    cuts
}

/// The decomposition of each direction whose factor is known: by the category that the record names, else by the default table.
fn decomposition(part: &Representation, of: Fingerprint, reasons: &mut Vec<Reason>) -> Vec<Decomposition> {
    let table = Categories::default();
    let mut all = Vec::new();
    for (item, speed) in fresh(part.speed.as_ref(), "speed", of) {
        let Speed { direction, factor, category, .. } = &speed.value;
        let Category { name, tolerance, jitter, .. } = category.as_ref().unwrap_or_else(|| table.of(*factor));
        let effect = format!(
            "the parametrisation factor in {direction} is {factor:.4}, {name}: a decomposition into points has the tolerance {tolerance} and \
             the jitter {jitter}"
        );
        reasons.push(Reason { item, basis: Some(speed.basis), effect });
        all.push(Decomposition {
            direction: *direction,
            category: name.clone(),
            tolerance: *tolerance,
            jitter: *jitter,
        });
    }
    all
}

/// Creases one by one; the smooth breaks together.
fn breaks(part: &Representation, of: Fingerprint, reasons: &mut Vec<Reason>) {
    let (mut smooth, mut basis) = (0, None);
    for (item, b) in fresh(part.breaks.as_ref(), "breaks", of) {
        if b.value.g == 0 {
            let effect =
                format!("the pieces meet at {} = {}: a foot there lies on a crease", b.value.direction, b.value.at);
            reasons.push(Reason { item, basis: Some(b.basis), effect });
        } else {
            smooth += 1;
            basis = basis.or(Some(b.basis));
        }
    }
    if smooth > 0 {
        let places = if smooth == 1 { "1 break".to_owned() } else { format!("{smooth} breaks") };
        let effect =
            format!("the pieces meet at {places} where the tangent is continuous: no foot there lies on a crease");
        reasons.push(Reason { item: "representation.breaks".to_owned(), basis, effect });
    }
}

fn closed(part: &Representation, of: Fingerprint, reasons: &mut Vec<Reason>) {
    if let Some(item) = part.closed.as_ref().filter(|item| !item.is_stale(of)) {
        let direction = match item.value {
            (false, false) => return,
            (true, false) => "u",
            (false, true) => "v",
            (true, true) => "u and in v",
        };
        let effect = format!("closed in {direction}: a foot on the seam is given at the lower parameter");
        reasons.push(Reason { item: "representation.closed".to_owned(), basis: Some(item.basis), effect });
    }
}
