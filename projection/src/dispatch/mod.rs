//! The dispatcher: from what is known of an entity to the plan by which its queries are answered.
//!
//! Knowledge is proved before it is believed. A class that the definition is proved not to have, or that belongs to an older
//! definition, is acquired again; what merely names places (cusps, loops) costs or spares work, and enters no bound.

mod class;
mod settings;

use std::sync::Arc;

use perpend_kernel::Definition;
use perpend_knowledge::{Kind, Record};

use self::class::Class;
use crate::analytic::Analytic;
use crate::answer::Method;
use crate::closed_form::ClosedForm;
use crate::landmarks::Landmarks;
use crate::plan::Plan;
use crate::query::DEFAULT_GAP;

/// A plan, and the closed form where there is one.
pub(crate) struct Dispatched {
    pub plan: Plan,
    pub closed_form: Option<ClosedForm>,
}

/// Makes the plan of a definition.
pub(crate) fn dispatch(definition: &Arc<Definition>, record: Option<&Record>, landmarks: &Landmarks) -> Dispatched {
    let mut reasons = Vec::new();
    let class = Class::of(definition, record, &mut reasons);
    let gap = DEFAULT_GAP * definition.size();
    let analytic = Analytic::new(definition, &class.kind, class.gap);
    let method = if analytic.is_some() && class.gap <= gap { Method::Analytic } else { Method::Hierarchy };
    reasons.push(class.reason(method, analytic.is_some(), gap));
    let settings = settings::settings(definition, record, landmarks, gap, &mut reasons);
    let closed_form = analytic.map(|analytic| ClosedForm::new(analytic, definition, has_one_minimum(&class.kind)));
    Dispatched { plan: Plan { method, settings, reasons }, closed_form }
}

/// Whether the distance to the whole shape has one local minimum at most, but for points from which a circle or all of it is equally near: seen along
/// a circle of the shape it has one, and so it has along what the circles are swept along.
fn has_one_minimum(kind: &Kind) -> bool {
    match kind {
        Kind::Plane { .. } | Kind::Sphere { .. } | Kind::Cylinder { .. } | Kind::Cone { .. } => true,
        Kind::Torus { major_radius, minor_radius, .. } => minor_radius < major_radius,
        _ => false,
    }
}
