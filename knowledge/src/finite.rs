//! Finds the first number of a record that is not finite.
//!
//! The search is a serde serializer that keeps nothing but the way to where it stands: it sees every field that a file
//! would hold, also those that come later.

use std::fmt::Display;

use serde::ser::{self, Serialize};

/// A number of a record is infinite or not a number.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{field} is {value}; numbers of a record are finite: correct it, or leave the item out")]
pub struct NonFinite {
    /// Where in the record: fields, indices and keys.
    pub field: String,
    /// The number.
    pub value: f64,
}

/// Checks that every number of `value` is finite.
pub(crate) fn check(value: &impl Serialize) -> Result<(), NonFinite> {
    value.serialize(&mut Search { way: Vec::new() }).map_err(|Stop(found)| found)
}

struct Search {
    way: Vec<Step>,
}

enum Step {
    Field(&'static str),
    Index(usize),
    Key(String),
}

/// The way the search ends early.
#[derive(Debug)]
struct Stop(NonFinite);

impl Display for Stop {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

impl std::error::Error for Stop {}

impl ser::Error for Stop {
    fn custom<T: Display>(message: T) -> Self {
        // Only a hand-written `Serialize` reports errors, and a record's have none.
        Self(NonFinite { field: message.to_string(), value: f64::NAN })
    }
}

impl Search {
    fn number(&self, value: f64) -> Result<(), Stop> {
        if value.is_finite() {
            return Ok(());
        }
        let mut field = String::new();
        for step in &self.way {
            match step {
                Step::Field(name) if field.is_empty() => field.push_str(name),
                Step::Field(name) => field.extend([".", name]),
                Step::Index(i) => field.push_str(&format!("[{i}]")),
                Step::Key(key) => field.push_str(&format!("[{key:?}]")),
            }
        }
        Err(Stop(NonFinite { field, value }))
    }

    fn within<T: Serialize + ?Sized>(&mut self, step: Step, value: &T) -> Result<(), Stop> {
        self.way.push(step);
        value.serialize(&mut *self)?;
        self.way.pop();
        Ok(())
    }
}

/// A compound value under way: counts the elements of a sequence, holds the key of a map's entry.
struct Compound<'a> {
    search: &'a mut Search,
    next: usize,
    key: String,
}

impl Compound<'_> {
    fn element<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Stop> {
        self.next += 1;
        self.search.within(Step::Index(self.next - 1), value)
    }
}

/// A key of a map as text: a formatter is a serializer of plain values.
struct KeyText<'a, T: ?Sized>(&'a T);

impl<T: Serialize + ?Sized> Display for KeyText<'_, T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.serialize(f)
    }
}

macro_rules! nothing_to_check {
    ($($method:ident: $type:ty),* $(,)?) => {
        $(fn $method(self, _: $type) -> Result<(), Stop> { Ok(()) })*
    };
}

impl<'a> ser::Serializer for &'a mut Search {
    type Ok = ();
    type Error = Stop;
    type SerializeSeq = Compound<'a>;
    type SerializeTuple = Compound<'a>;
    type SerializeTupleStruct = Compound<'a>;
    type SerializeTupleVariant = Compound<'a>;
    type SerializeMap = Compound<'a>;
    type SerializeStruct = Compound<'a>;
    type SerializeStructVariant = Compound<'a>;

    nothing_to_check! {
        serialize_bool: bool,
        serialize_i8: i8,
        serialize_i16: i16,
        serialize_i32: i32,
        serialize_i64: i64,
        serialize_u8: u8,
        serialize_u16: u16,
        serialize_u32: u32,
        serialize_u64: u64,
        serialize_char: char,
        serialize_str: &str,
        serialize_bytes: &[u8],
        serialize_unit_struct: &'static str,
    }

    fn serialize_f32(self, value: f32) -> Result<(), Stop> {
        self.number(f64::from(value))
    }

    fn serialize_f64(self, value: f64) -> Result<(), Stop> {
        self.number(value)
    }

    fn serialize_none(self) -> Result<(), Stop> {
        Ok(())
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<(), Stop> {
        value.serialize(self)
    }

    fn serialize_unit(self) -> Result<(), Stop> {
        Ok(())
    }

    fn serialize_unit_variant(self, _: &'static str, _: u32, _: &'static str) -> Result<(), Stop> {
        Ok(())
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(self, _: &'static str, value: &T) -> Result<(), Stop> {
        value.serialize(self)
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        value: &T,
    ) -> Result<(), Stop> {
        value.serialize(self)
    }

    fn serialize_seq(self, _: Option<usize>) -> Result<Compound<'a>, Stop> {
        Ok(Compound { search: self, next: 0, key: String::new() })
    }

    fn serialize_tuple(self, _: usize) -> Result<Compound<'a>, Stop> {
        self.serialize_seq(None)
    }

    fn serialize_tuple_struct(self, _: &'static str, _: usize) -> Result<Compound<'a>, Stop> {
        self.serialize_seq(None)
    }

    fn serialize_tuple_variant(self, _: &'static str, _: u32, _: &'static str, _: usize) -> Result<Compound<'a>, Stop> {
        self.serialize_seq(None)
    }

    fn serialize_map(self, _: Option<usize>) -> Result<Compound<'a>, Stop> {
        self.serialize_seq(None)
    }

    fn serialize_struct(self, _: &'static str, _: usize) -> Result<Compound<'a>, Stop> {
        self.serialize_seq(None)
    }

    fn serialize_struct_variant(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: usize,
    ) -> Result<Compound<'a>, Stop> {
        self.serialize_seq(None)
    }
}

macro_rules! sequence {
    ($($trait:ident :: $method:ident),*) => {
        $(impl ser::$trait for Compound<'_> {
            type Ok = ();
            type Error = Stop;

            fn $method<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Stop> {
                self.element(value)
            }

            fn end(self) -> Result<(), Stop> {
                Ok(())
            }
        })*
    };
}

sequence!(
    SerializeSeq::serialize_element,
    SerializeTuple::serialize_element,
    SerializeTupleStruct::serialize_field,
    SerializeTupleVariant::serialize_field
);

macro_rules! fields {
    ($($trait:ident),*) => {
        $(impl ser::$trait for Compound<'_> {
            type Ok = ();
            type Error = Stop;

            fn serialize_field<T: Serialize + ?Sized>(&mut self, name: &'static str, value: &T) -> Result<(), Stop> {
                self.search.within(Step::Field(name), value)
            }

            fn end(self) -> Result<(), Stop> {
                Ok(())
            }
        })*
    };
}

fields!(SerializeStruct, SerializeStructVariant);

impl ser::SerializeMap for Compound<'_> {
    type Ok = ();
    type Error = Stop;

    fn serialize_key<T: Serialize + ?Sized>(&mut self, key: &T) -> Result<(), Stop> {
        self.key = KeyText(key).to_string();
        Ok(())
    }

    fn serialize_value<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Stop> {
        let key = std::mem::take(&mut self.key);
        self.search.within(Step::Key(key), value)
    }

    fn end(self) -> Result<(), Stop> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use perpend_kernel::{EntityId, Fingerprint, Spacing};

    use crate::{
        Basis, Classification, Intent, Item, Kind, Operation, Record, Relation, Relationship, Representation, Value,
    };

    fn of() -> Fingerprint {
        "fnv1a64:0123456789abcdef".parse().expect("a fingerprint")
    }

    fn item<T>(value: T) -> Item<T> {
        Item { value, basis: Basis::Defined, tolerance: 0.0, of: of() }
    }

    fn field(record: &Record) -> String {
        record.validate().expect_err("not finite").field
    }

    #[test]
    fn a_number_that_is_not_finite_is_named_by_its_way() {
        assert_eq!(Record::default().validate(), Ok(()));
        let part = Representation { length: Some(item(f64::NAN)), ..Representation::default() };
        assert_eq!(field(&Record { representation: Some(part), ..Record::default() }), "representation.length.value");
        let closed = Item { basis: Basis::Proved { gap: f64::INFINITY }, ..item((true, false)) };
        let part = Representation { closed: Some(closed), ..Representation::default() };
        assert_eq!(
            field(&Record { representation: Some(part), ..Record::default() }),
            "representation.closed.basis.gap"
        );
        let kind = Kind::Line { origin: DVec3::ZERO, direction: DVec3::NAN, range: (0.0, 1.0) };
        let class = Classification { kind: Some(item(kind)), ..Classification::default() };
        let record = Record { classification: Some(class), ..Record::default() };
        assert_eq!(field(&record), "classification.kind.value.direction[0]");
        let points = vec![DVec3::ZERO, DVec3::new(0.0, 0.0, f64::NEG_INFINITY)];
        let operation = Operation::Interpolation { degree: (3, 0), points, columns: 0, spacing: Spacing::Uniform };
        let intent = Intent::new(operation, &[]);
        assert_eq!(field(&Record { intent: vec![intent], ..Record::default() }), "intent[0].operation.points[1][2]");
        let relationship = Relationship {
            kind: Relation::Offset,
            target: EntityId::new(1),
            parameters: [("a".to_owned(), Value::Number(1.0)), ("b".to_owned(), Value::Numbers(vec![0.0, f64::NAN]))]
                .into(),
            checked: None,
        };
        let error = Record { relationships: vec![relationship], ..Record::default() }.validate().expect_err("a NaN");
        assert_eq!(
            error.to_string(),
            "relationships[0].parameters[\"b\"][1] is NaN; numbers of a record are finite: correct it, or leave the item out"
        );
    }
}
