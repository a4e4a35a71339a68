//! The walk over an assembly: every body where each of its occurrences puts it.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use glam::DAffine3;
use perpend::Units;

use super::body::{BodyReader, FACES, LocalBody, SHEETS, SHELLS, SOLIDS, of_text};
use super::context::{Scales, Stated};
use super::entities::{Entities, Halt, MAX_DEPTH, Understood};
use super::error::ReadError;
use super::parse::parse;
use super::placed::is_mirror;
use super::placement::{Geometry, from_to, out_of};
use super::structure::{Relation, Structure};
use super::style::Colours;
use crate::source::{NotUnderstood, SourcePart};

/// How often a file's entities may be used, in pieces (entities and control points): real files stay below one for every ten of their bytes, since
/// few surfaces and points serve more than a handful of faces.
fn budget(bytes: usize) -> u64 {
    1_000_000 + 2 * bytes as u64
}

/// What the file says of its part.
pub(super) fn read(bytes: &[u8], max_pieces: u64, stop: Arc<AtomicBool>) -> Result<SourcePart, ReadError> {
    let all = parse(bytes, &stop)?;
    let limit = budget(bytes.len());
    let entities = Entities::new(all, limit, max_pieces, stop);
    let structure = Structure::of(&entities);
    let colours = Colours::of(&entities);
    let mut walk = Walk::new(&entities, &structure, &colours, max_pieces);
    walk.whole();
    match entities.halt() {
        None => {}
        Some(Halt::Spent(entity)) => return Err(ReadError::TooManyCopies { entity, limit }),
        Some(Halt::Full(entity)) => return Err(ReadError::TooManyCopies { entity, limit: max_pieces }),
        // whoever said so does not listen any more
        Some(Halt::Stopped) => return Err(ReadError::TooSlow { limit: Duration::ZERO }),
    }
    walk.finished()
}

/// Solids that are not read: where no representation holds one, it is told of all the same.
const UNREAD_SOLIDS: [&str; 8] = [
    "CSG_SOLID",
    "EXTRUDED_AREA_SOLID",
    "EXTRUDED_FACE_SOLID",
    "REVOLVED_AREA_SOLID",
    "REVOLVED_FACE_SOLID",
    "SOLID_REPLICA",
    "SWEPT_DISK_SOLID",
    "TESSELLATED_SOLID",
];

/// Items of one kind that were left out, told of together.
struct LeftOut {
    first: u64,
    count: usize,
    reason: &'static str,
}

/// Where the walk is.
struct Place<'a> {
    map: DAffine3,
    /// The names of the occurrences that lead here.
    names: &'a [String],
    colour: Option<[f64; 3]>,
    depth: usize,
    /// Whether bodies are only read and not placed, since nothing can be placed here.
    silent: bool,
}

struct Walk<'a> {
    entities: &'a Entities,
    structure: &'a Structure,
    colours: &'a Colours,
    part: SourcePart,
    /// What the contexts state, by their numbers.
    stated: HashMap<u64, Stated>,
    /// Bodies that were read, by their numbers and the context that they were read in.
    bodies: HashMap<(u64, Option<u64>), Rc<LocalBody>>,
    /// Bodies, faces, representations, occurrences that were met.
    met: HashSet<u64>,
    left_out: BTreeMap<String, LeftOut>,
    /// Metres of the largest uncertainty of a context that was used.
    uncertainty: f64,
    pieces: u64,
    max_pieces: u64,
    overfull: Option<u64>,
}

impl<'a> Walk<'a> {
    fn new(entities: &'a Entities, structure: &'a Structure, colours: &'a Colours, max_pieces: u64) -> Self {
        let mut walk = Self {
            entities,
            structure,
            colours,
            part: SourcePart {
                units: Units::default(),
                tolerance: 0.0,
                edges: Vec::new(),
                faces: Vec::new(),
                bodies: Vec::new(),
                not_understood: Vec::new(),
            },
            stated: HashMap::new(),
            bodies: HashMap::new(),
            met: HashSet::new(),
            left_out: BTreeMap::new(),
            uncertainty: 0.0,
            pieces: 0,
            max_pieces,
            overfull: None,
        };
        walk.part.units = walk.first_units();
        walk
    }

    /// The unit of the first representation that holds a body, or else of the first that states one.
    fn first_units(&mut self) -> Units {
        let structure = self.structure;
        let holds_body = |items: &[u64]| items.iter().any(|item| is_body(self.entities, *item));
        let with_bodies = structure.representations.values().filter(|shape| holds_body(&shape.items));
        let contexts: Vec<u64> =
            with_bodies.chain(structure.representations.values()).map(|shape| shape.context).collect();
        for context in contexts {
            let stated = self.stated(context);
            if stated.metres.is_some() {
                return stated.units();
            }
        }
        Units::default()
    }

    fn stated(&mut self, context: u64) -> Stated {
        if let Some(stated) = self.stated.get(&context) {
            return *stated;
        }
        let stated = Stated::of(self.entities, context).unwrap_or_else(|left_out| {
            self.part.not_understood.push(left_out);
            Stated::default()
        });
        self.stated.insert(context, stated);
        stated
    }

    fn geometry(&mut self, context: Option<u64>) -> Geometry<'a> {
        let stated = context.map_or_else(Stated::default, |context| self.stated(context));
        let scales: Scales = stated.scales(self.part.units);
        Geometry { entities: self.entities, scales }
    }

    /// The products from their roots, then whatever no product led to.
    fn whole(&mut self) {
        let (entities, structure) = (self.entities, self.structure);
        let still = |names| Place { map: DAffine3::IDENTITY, names, colour: None, depth: 0, silent: false };
        for root in structure.roots() {
            self.definition(root, &mut Vec::new(), &still(&[]));
        }
        for occurrence in structure.occurrences.values().flatten() {
            if !self.met.contains(&occurrence.id) {
                let reason = "no product leads to it, as in an assembly that contains itself";
                self.leave_out(occurrence.id, reason);
            }
        }
        for (id, shape) in &structure.representations {
            let forgotten = |item: &u64| is_body(entities, *item) && !self.met.contains(item);
            if shape.items.iter().any(forgotten) && !self.met.contains(id) {
                for shape in structure.with_linked(vec![*id], None) {
                    if !self.met.contains(&shape) {
                        self.representation(shape, &mut Vec::new(), &still(&[]), None);
                    }
                }
            }
        }
        // what else lies in representations that nothing leads to is told of, as what lies in the others is
        for (id, shape) in &structure.representations {
            if !self.met.contains(id) && is_shape(entities, *id) {
                for item in &shape.items {
                    if !is_body(entities, *item) && mapped_representation(entities, *item).is_none() {
                        self.other(*item);
                    }
                }
            }
        }
        for (id, _) in entities.iter() {
            if entities.is(id, &UNREAD_SOLIDS) {
                self.other(id);
            }
        }
        // single bodies, then shells without a body, then faces without a shell
        for kinds in [&SOLIDS[..], &SHEETS, &SHELLS, &FACES] {
            for (id, _) in entities.iter() {
                if entities.halt().is_some() {
                    return;
                }
                if entities.is(id, kinds) && !self.met.contains(&id) && !self.is_used_up(id) {
                    self.body(id, None, &still(&[]), None);
                }
            }
        }
    }

    /// Whether all faces of a shell were met, or an oriented face or shell stands for another that has its own turn.
    fn is_used_up(&self, id: u64) -> bool {
        let Some(values) = self.entities.simple_of(id, &SHELLS) else {
            return self.entities.is(id, &["ORIENTED_FACE"]);
        };
        values.keyword.starts_with("ORIENTED")
            || values.references(1).is_ok_and(|faces| faces.iter().all(|face| self.met.contains(face)))
    }

    /// A product definition: its representations and the occurrences within it.
    fn definition(&mut self, id: u64, above: &mut Vec<u64>, place: &Place<'_>) {
        let structure = self.structure;
        if self.entities.spend(id, 1).is_err() {
            return;
        }
        let shapes = structure.shapes_of(id);
        let occurrences = structure.occurrences.get(&id).map_or(&[][..], Vec::as_slice);
        // a mapped item of a representation that an occurrence places must not place it once more
        let placed: HashSet<u64> = occurrences
            .iter()
            .filter(|occurrence| occurrence.relation.is_some())
            .flat_map(|occurrence| structure.shapes_of(occurrence.child))
            .collect();
        let mapped_before = self.met.len();
        for shape in &shapes {
            self.representation(*shape, &mut Vec::new(), place, Some((id, &placed)));
        }
        let has_items = self.met.len() > mapped_before;
        if shapes.is_empty() && occurrences.is_empty() && structure.refers_to_files {
            self.leave_out(id, "its shape lies in another file: import that file too");
        }
        above.push(id);
        for occurrence in occurrences {
            self.met.insert(occurrence.id);
            if above.contains(&occurrence.child) {
                self.say(self.entities.refuse(occurrence.id, "the assembly contains itself here".to_owned()));
                continue;
            }
            if above.len() > MAX_DEPTH {
                self.say(self.entities.refuse(occurrence.id, "assemblies are nested too deeply".to_owned()));
                continue;
            }
            let (map, silent) = match occurrence.relation {
                Some(relation) => match self.occurrence_map(relation, occurrence.child, place) {
                    Ok(map) => (map, false),
                    Err(left_out) => {
                        self.say(left_out);
                        (DAffine3::IDENTITY, true)
                    }
                },
                // mapped items of the parent place what this occurrence only names
                None if has_items && self.is_mapped(&shapes, occurrence.child) => continue,
                None => (place.map, false),
            };
            let mut names = place.names.to_vec();
            names.push(occurrence.name.clone());
            let colour = self.colours.get(occurrence.id).or(place.colour);
            let silent = silent || place.silent;
            let there = Place { map, names: &names, colour, depth: place.depth + 1, silent };
            self.definition(occurrence.child, above, &there);
            if self.entities.halt().is_some() {
                break;
            }
        }
        above.pop();
    }

    /// Whether mapped items of these representations bring a representation of a product.
    fn is_mapped(&self, shapes: &[u64], child: u64) -> bool {
        let brought = self.structure.shapes_of(child);
        let items =
            shapes.iter().filter_map(|shape| self.structure.representations.get(shape)).flat_map(|shape| &shape.items);
        items
            .into_iter()
            .filter_map(|item| mapped_representation(self.entities, *item))
            .any(|shape| brought.contains(&shape))
    }

    /// The map of an occurrence of `child`, out to the whole.
    fn occurrence_map(&mut self, relation: Relation, child: u64, place: &Place<'_>) -> Understood<DAffine3> {
        let map = self.relation_map(relation)?;
        let shapes = self.structure.shapes_of(child);
        // the first representation is to be the child's; some writers turn the relation round
        let turned = !shapes.contains(&relation.first) && shapes.contains(&relation.second);
        Ok(place.map * if turned { map.inverse() } else { map })
    }

    /// The map from the first representation of a relation into the second.
    fn relation_map(&mut self, relation: Relation) -> Understood<DAffine3> {
        let entities = self.entities;
        let context = |shape: u64| self.structure.representations.get(&shape).map(|shape| shape.context);
        let (first, second) = (context(relation.first), context(relation.second));
        let Some(items) = entities.simple_of(relation.operator, &["ITEM_DEFINED_TRANSFORMATION"]) else {
            let map = self.geometry(second).operator(relation.operator)?;
            return self.unmirrored(relation.id, map);
        };
        let from = self.geometry(first).frame(items.reference(2)?)?;
        let to = self.geometry(second).frame(items.reference(3)?)?;
        Ok(from_to(&from, &to))
    }

    fn unmirrored(&self, id: u64, map: DAffine3) -> Understood<DAffine3> {
        if is_mirror(&map) {
            return Err(self
                .entities
                .refuse(id, "it mirrors what it places: write the file with the mirrored part itself".to_owned()));
        }
        Ok(map)
    }

    /// A representation: its bodies, and what is placed in it. `within`: the product definition that it belongs to, and the representations
    /// that occurrences place in it.
    fn representation(
        &mut self,
        id: u64,
        above: &mut Vec<u64>,
        place: &Place<'_>,
        within: Option<(u64, &HashSet<u64>)>,
    ) {
        let structure = self.structure;
        let Some(shape) = structure.representations.get(&id) else { return };
        if self.entities.spend(id, 1 + shape.items.len()).is_err() {
            return;
        }
        if above.contains(&id) || above.len() > MAX_DEPTH {
            self.say(self.entities.refuse(id, "it contains itself, or is nested too deeply".to_owned()));
            return;
        }
        self.met.insert(id);
        above.push(id);
        for item in &shape.items {
            if is_body(self.entities, *item) {
                self.body(*item, Some(shape.context), place, within.map(|(definition, _)| definition));
            } else if let Some(mapped) = mapped_representation(self.entities, *item) {
                if within.is_none_or(|(_, placed)| !placed.contains(&mapped)) {
                    self.mapped(*item, mapped, shape.context, above, place, within);
                }
            } else {
                self.other(*item);
            }
        }
        for relation in structure.placed.get(&id).into_iter().flatten() {
            let map = self.relation_map(*relation);
            self.placed(relation.first, map, above, place, within);
        }
        above.pop();
    }

    /// What a mapped item brings.
    fn mapped(
        &mut self,
        item: u64,
        shape: u64,
        context: u64,
        above: &mut Vec<u64>,
        place: &Place<'_>,
        within: Option<(u64, &HashSet<u64>)>,
    ) {
        let map = self.mapped_map(item, shape, context);
        let colour = self.colours.get(item).or(place.colour);
        let here = Place { colour, ..*place };
        self.placed(shape, map, above, &here, within);
    }

    fn mapped_map(&mut self, item: u64, shape: u64, context: u64) -> Understood<DAffine3> {
        let entities = self.entities;
        let values = entities.simple_of(item, &["MAPPED_ITEM"]).ok_or_else(|| entities.unexpected(item, "a copy"))?;
        let (source, target) = (values.reference(1)?, values.reference(2)?);
        let source = entities
            .simple_of(source, &["REPRESENTATION_MAP"])
            .ok_or_else(|| entities.unexpected(source, "what is copied"))?;
        let inner = self.structure.representations.get(&shape).map(|shape| shape.context);
        let origin = self.geometry(inner).frame(source.reference(0)?)?;
        let outer = self.geometry(Some(context));
        if entities.is(target, &["CARTESIAN_TRANSFORMATION_OPERATOR_3D"]) {
            let map = outer.operator(target)? * out_of(&origin).inverse();
            return self.unmirrored(target, map);
        }
        Ok(from_to(&origin, &outer.frame(target)?))
    }

    /// A representation placed in another by a map.
    fn placed(
        &mut self,
        shape: u64,
        map: Understood<DAffine3>,
        above: &mut Vec<u64>,
        place: &Place<'_>,
        within: Option<(u64, &HashSet<u64>)>,
    ) {
        let (map, silent) = match map {
            Ok(map) => (place.map * map, place.silent),
            Err(left_out) => {
                self.say(left_out);
                (DAffine3::IDENTITY, true)
            }
        };
        let there = Place { map, silent, depth: place.depth + 1, ..*place };
        self.representation(shape, above, &there, within);
    }

    /// A body, read once and placed here.
    fn body(&mut self, id: u64, context: Option<u64>, place: &Place<'_>, definition: Option<u64>) {
        self.met.insert(id);
        let key = (id, context);
        let local = match self.bodies.get(&key) {
            Some(local) => Rc::clone(local),
            None => {
                let local = BodyReader::new(self.geometry(context), self.colours).read(id);
                self.met.extend(&local.met);
                self.part.not_understood.extend(local.not_understood.iter().cloned());
                Rc::clone(self.bodies.entry(key).or_insert(Rc::new(local)))
            }
        };
        if local.is_empty() || place.silent || self.entities.spend(id, 1).is_err() {
            return;
        }
        let name = self.name(id, place, definition);
        self.pieces += (local.pieces + of_text(&name)) as u64;
        if self.pieces > self.max_pieces {
            self.overfull.get_or_insert(id);
            return;
        }
        if let Some(stated) = context.map(|context| self.stated(context)) {
            self.uncertainty = self.uncertainty.max(stated.uncertainty.unwrap_or(0.0));
        }
        let colour = self.colours.get(id).or(place.colour);
        if let Err(error) = local.place(&place.map, (id, name, colour), &mut self.part) {
            self.say(self.entities.refuse(id, format!("where the assembly puts it, {error}")));
        }
    }

    /// The name of a body: the occurrences that lead to it, or its product, then its own.
    fn name(&self, id: u64, place: &Place<'_>, definition: Option<u64>) -> String {
        let product = definition.and_then(|definition| self.structure.definitions.get(&definition));
        let mut names: Vec<&str> = place.names.iter().map(String::as_str).collect();
        if names.is_empty() {
            names.extend(product.map(String::as_str));
        }
        let own = self.entities.simple(id).map_or("", |values| values.text(0));
        let told = product.is_some_and(|product| product == own) || names.last() == Some(&own);
        if !told && own != "NONE" {
            names.push(own);
        }
        names.retain(|name| !name.is_empty());
        names.join("/")
    }

    /// An item of a representation that is no body: told of where it is geometry that was left out.
    fn other(&mut self, id: u64) {
        let entities = self.entities;
        let wire = "curves and points without faces are not imported";
        let keyword = entities.keyword(id);
        match keyword.as_str() {
            "AXIS1_PLACEMENT" | "AXIS2_PLACEMENT_3D" | "AXIS2_PLACEMENT_2D" | "CARTESIAN_POINT" | "DIRECTION"
            | "PLACEMENT" | "POINT" | "VECTOR" | "VERTEX_POINT" => {}
            name if name.ends_with("REPRESENTATION_ITEM")
                || name.ends_with("STYLED_ITEM")
                || name.starts_with("CAMERA")
                || name.contains("ANNOTATION") => {}
            "GEOMETRIC_CURVE_SET" => self.leave_out(id, wire),
            "GEOMETRIC_SET" => {
                let elements = entities.simple(id).and_then(|values| values.references(1).ok()).unwrap_or_default();
                for element in elements {
                    if is_body(entities, element) {
                        self.other(element);
                    } else if entities.keyword(element).contains("SURFACE") || entities.is(element, &["PLANE"]) {
                        self.leave_out(element, "a surface that no face bounds is not imported");
                    } else if !entities.is(element, &["CARTESIAN_POINT", "AXIS2_PLACEMENT_3D"]) {
                        self.leave_out(element, wire);
                    }
                }
            }
            name if name.starts_with("TESSELLATED") || name.contains("TRIANGULATED") => {
                // triangles that stand for an exact body are there to be looked at
                let link = entities.simple(id).and_then(|values| values.reference(2).ok());
                if link.is_none() {
                    self.leave_out(id, "triangles without exact surfaces are not imported");
                }
            }
            name if name.ends_with("CURVE") || name == "LINE" || name == "CIRCLE" || name == "ELLIPSE" => {
                self.leave_out(id, wire);
            }
            _ => self.leave_out(id, "this kind of geometry is not imported"),
        }
    }

    /// Tells of an item together with others of its kind, once.
    fn leave_out(&mut self, id: u64, reason: &'static str) {
        if self.met.insert(id) {
            let kind =
                self.left_out.entry(self.entities.keyword(id)).or_insert(LeftOut { first: id, count: 0, reason });
            kind.count += 1;
            kind.first = kind.first.min(id);
        }
    }

    fn say(&mut self, left_out: NotUnderstood) {
        self.part.not_understood.push(left_out);
    }

    /// The part, with names told apart.
    fn finished(mut self) -> Result<SourcePart, ReadError> {
        if let Some(entity) = self.overfull {
            return Err(ReadError::TooManyCopies { entity, limit: self.max_pieces });
        }
        for (keyword, kind) in std::mem::take(&mut self.left_out) {
            let reason = match kind.count {
                1 => kind.reason.to_owned(),
                many => format!("{} ({many} of this kind)", kind.reason),
            };
            self.part.not_understood.push(NotUnderstood { entity: kind.first, keyword, reason });
        }
        if !self.part.faces.is_empty() && self.stated.values().all(|stated| stated.metres.is_none()) {
            let reason = "no unit of length is stated: its numbers are taken for millimetres".to_owned();
            let keyword = "GLOBAL_UNIT_ASSIGNED_CONTEXT".to_owned();
            let entity = self.stated.keys().min().copied().unwrap_or(0);
            self.part.not_understood.push(NotUnderstood { entity, keyword, reason });
        }
        if self.part.faces.is_empty() && self.part.not_understood.is_empty() {
            let first = self.entities.iter().next().map_or(0, |(id, _)| id);
            self.say(self.entities.refuse(first, "nothing of the file is imported: it holds no faces".to_owned()));
        }
        let mut said = HashSet::new();
        self.part.not_understood.retain(|left_out| said.insert((left_out.entity, left_out.reason.clone())));
        let metres = if self.uncertainty > 0.0 { self.uncertainty } else { 1e-6 };
        self.part.tolerance = metres / self.part.units.in_metres();
        let mut times: HashMap<String, usize> = HashMap::new();
        for body in &mut self.part.bodies {
            let times = times.entry(body.name.clone()).or_default();
            *times += 1;
            if *times > 1 {
                body.name = format!("{} ({times})", body.name);
            }
        }
        Ok(self.part)
    }
}

/// Whether an entity is read as a body: a solid, a sheet, a shell, a face.
fn is_body(entities: &Entities, id: u64) -> bool {
    [&SOLIDS[..], &SHEETS, &SHELLS, &FACES].into_iter().any(|kinds| entities.is(id, kinds))
}

/// Whether an entity is a representation of a shape, and not of what is said or drawn of one.
fn is_shape(entities: &Entities, id: u64) -> bool {
    let ends = |name: &str| name.ends_with("SHAPE_REPRESENTATION");
    entities.simple(id).is_some_and(|values| ends(values.keyword))
        || entities.parts(id).iter().any(|part| ends(&part.name))
}

/// The representation that a mapped item copies.
fn mapped_representation(entities: &Entities, id: u64) -> Option<u64> {
    let source = entities.simple_of(id, &["MAPPED_ITEM"])?.reference(1).ok()?;
    entities.simple_of(source, &["REPRESENTATION_MAP"])?.reference(1).ok()
}
