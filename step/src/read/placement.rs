//! Points, directions and frames, in the part's unit of length.

use glam::{DAffine3, DMat3, DVec3};
use perpend::Frame;

use super::context::Scales;
use super::entities::{Entities, Understood};
use super::placed::is_mirror;

/// The geometry of a representation: its entities, and what their numbers mean.
#[derive(Clone, Copy)]
pub(super) struct Geometry<'a> {
    pub(super) entities: &'a Entities,
    pub(super) scales: Scales,
}

impl Geometry<'_> {
    pub(super) fn point(&self, id: u64) -> Understood<DVec3> {
        let values =
            self.entities.simple_of(id, &["CARTESIAN_POINT"]).ok_or_else(|| self.entities.unexpected(id, "a point"))?;
        let point = DVec3::from_array(three(&values.reals(1)?).ok_or_else(|| not_three(&values))?) * self.scales.length;
        if point.is_finite() { Ok(point) } else { Err(values.refuse("a coordinate is not finite".to_owned())) }
    }

    /// A direction, of unit length.
    pub(super) fn direction(&self, id: u64) -> Understood<DVec3> {
        let values =
            self.entities.simple_of(id, &["DIRECTION"]).ok_or_else(|| self.entities.unexpected(id, "a direction"))?;
        let ratios = DVec3::from_array(three(&values.reals(1)?).ok_or_else(|| not_three(&values))?);
        let largest = ratios.abs().max_element();
        let direction = (ratios / largest).normalize();
        if largest > 0.0 && direction.is_finite() {
            Ok(direction)
        } else {
            Err(values.refuse(format!("{ratios} has no direction")))
        }
    }

    /// A vector with its length.
    pub(super) fn vector(&self, id: u64) -> Understood<DVec3> {
        let values =
            self.entities.simple_of(id, &["VECTOR"]).ok_or_else(|| self.entities.unexpected(id, "a vector"))?;
        let vector = self.direction(values.reference(1)?)? * (values.real(2)? * self.scales.length);
        if vector.is_finite() && vector != DVec3::ZERO {
            Ok(vector)
        } else {
            Err(values.refuse("its length is zero or not finite".to_owned()))
        }
    }

    /// The point and the direction of an axis.
    pub(super) fn axis(&self, id: u64) -> Understood<(DVec3, DVec3)> {
        let values = self
            .entities
            .simple_of(id, &["AXIS1_PLACEMENT", "AXIS2_PLACEMENT_3D"])
            .ok_or_else(|| self.entities.unexpected(id, "an axis"))?;
        let direction = values.reference(2).map_or(Ok(DVec3::Z), |axis| self.direction(axis))?;
        Ok((self.point(values.reference(1)?)?, direction))
    }

    /// A frame; directions that the file leaves out, or gives along one another, are those of ISO 10303-42.
    pub(super) fn frame(&self, id: u64) -> Understood<Frame> {
        let values = self
            .entities
            .simple_of(id, &["AXIS2_PLACEMENT_3D"])
            .ok_or_else(|| self.entities.unexpected(id, "a placement in space"))?;
        let centre = self.point(values.reference(1)?)?;
        let axis = values.reference(2).map_or(Ok(DVec3::Z), |axis| self.direction(axis))?;
        let given = values.reference(3).ok().map(|xdir| self.direction(xdir)).transpose()?;
        let usual = if axis.cross(DVec3::X).length() > 1e-8 { DVec3::X } else { DVec3::Y };
        given
            .and_then(|xdir| Frame::new(centre, axis, xdir).ok())
            .map_or_else(|| Frame::new(centre, axis, usual), Ok)
            .map_err(|error| values.refuse(error.to_string()))
    }

    /// The map of a CARTESIAN_TRANSFORMATION_OPERATOR_3D.
    pub(super) fn operator(&self, id: u64) -> Understood<DAffine3> {
        let values = self
            .entities
            .simple_of(id, &["CARTESIAN_TRANSFORMATION_OPERATOR_3D"])
            .ok_or_else(|| self.entities.unexpected(id, "a transformation"))?;
        // some writers repeat the inherited texts, so places count from the origin: axis 1, axis 2, origin, scale, axis 3
        let is_point = |i: &usize| values.reference(*i).is_ok_and(|id| self.entities.is(id, &["CARTESIAN_POINT"]));
        let origin = (3..6).find(is_point).ok_or_else(|| values.refuse("it has no origin".to_owned()))?;
        let along = |index: usize| values.reference(index).ok().map(|axis| self.direction(axis)).transpose();
        let z = along(origin + 2)?.unwrap_or(DVec3::Z);
        let x =
            along(origin - 2)?.unwrap_or_else(|| if z.cross(DVec3::X).length() > 1e-8 { DVec3::X } else { DVec3::Y });
        let frame = Frame::new(DVec3::ZERO, z, x).map_err(|error| values.refuse(error.to_string()))?;
        // axis 2 only tells on which side y lies
        let side = along(origin - 1)?.map_or(1.0, |y| if y.dot(frame.ydir()) < 0.0 { -1.0 } else { 1.0 });
        let scale = values.real(origin + 1).unwrap_or(1.0);
        if !(scale.is_finite() && scale > 0.0) {
            return Err(values.refuse(format!("its scale is {scale}; it must be positive")));
        }
        let turn = DMat3::from_cols(frame.xdir, side * frame.ydir(), frame.axis) * scale;
        Ok(DAffine3::from_mat3_translation(turn, self.point(values.reference(origin)?)?))
    }

    /// As [`operator`](Self::operator), no mirror.
    pub(super) fn turn(&self, id: u64) -> Understood<DAffine3> {
        let map = self.operator(id)?;
        if is_mirror(&map) { Err(self.entities.refuse(id, "it mirrors".to_owned())) } else { Ok(map) }
    }
}

/// The map from a frame's own coordinates to those around it.
pub(super) fn out_of(frame: &Frame) -> DAffine3 {
    DAffine3::from_mat3_translation(DMat3::from_cols(frame.xdir, frame.ydir(), frame.axis), frame.centre)
}

/// The map that takes one frame to another; exactly none where they are the same.
pub(super) fn from_to(from: &Frame, to: &Frame) -> DAffine3 {
    if from == to {
        return DAffine3::IDENTITY;
    }
    // the columns are of unit length and across one another, so that the transpose is the inverse
    let turn = out_of(to).matrix3 * out_of(from).matrix3.transpose();
    DAffine3::from_mat3_translation(turn, to.centre - turn * from.centre)
}

fn three(values: &[f64]) -> Option<[f64; 3]> {
    values.try_into().ok()
}

fn not_three(values: &super::entities::Values<'_>) -> crate::source::NotUnderstood {
    values.refuse("it has not three coordinates".to_owned())
}
