//! The command line.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueEnum, value_parser};
use perpend::{DVec3, EntityId, Method, Model, ReadError, Trust};

use crate::names;

/// Certified nearest points on the NURBS curves and surfaces of a model.
///
/// For each point, perpend gives the globally nearest point of an entity, and with it a proven lower bound: the true
/// distance lies between `lower_bound` and `distance`.
#[derive(Debug, Parser)]
#[command(name = "perpend", version, max_term_width = 100, after_help = EXIT_CODES)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

const EXIT_CODES: &str = "\
Exit codes: 0 done; 1 an input is wrong (standard error says what, where and how to mend it); 2 wrong usage.";

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Import a part from a STEP file: faces, edges and bodies become a model
    Import(ImportArguments),
    /// Validate a model file and say what it holds
    Check(CheckArguments),
    /// Acquire what can be known of the entities and write the model with it
    Learn(LearnArguments),
    /// Show the entities of a model and what is known of them
    Show(ShowArguments),
    /// Explain how an entity's queries are answered, and why so
    Explain(ExplainArguments),
    /// Remove what definitions do not need; the shapes stay
    Clean(CleanArguments),
    /// Remove what definitions hardly need, within a tolerance that you name; the originals are kept
    Purge(PurgeArguments),
    /// Take curves apart where they have cusps and loops
    Decompose(DecomposeArguments),
    /// Give purged entities their originals again
    Restore(RestoreArguments),
    /// Make an entity again as it was made, and say how far it is from that
    Replay(ReplayArguments),
    /// List the entities that an edit of one would touch
    Impact(ImpactArguments),
    /// Project points: the nearest point of an entity, or of the whole model, to each
    Project(ProjectArguments),
    /// Find all stationary points of the distance from a point to an entity
    Stationary(StationaryArguments),
    /// Make a page that shows a model and how far points lie from it
    Report(ReportArguments),
    /// Write a model for other programs: STEP, triangles (OBJ, STL), or what is known as JSON
    Export(ExportArguments),
}

/// What happens to knowledge of the model that is false.
#[derive(Debug, Args)]
pub(crate) struct TrustArguments {
    /// Acquire knowledge that is false or stale again, instead of refusing a model that states something false
    #[arg(long)]
    repair: bool,
}

impl TrustArguments {
    /// Reads the model.
    pub(crate) fn read(&self, model: &Path) -> Result<Model, ReadError> {
        Model::read_with(model, if self.repair { Trust::Repair } else { Trust::Refuse })
    }
}

#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct ImportArguments {
    /// The part (STEP: AP203, AP214, AP242)
    pub(crate) part: PathBuf,
    /// The file for the model (RON), written whole or not at all
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,
    /// Take it for success if something was not understood: it is listed, and the rest is written, in either case
    #[arg(long)]
    pub(crate) partial: bool,
    /// The largest file that is read, in MiB [default: 512]
    #[arg(long, value_name = "MIB", value_parser = value_parser!(u64).range(1..=1 << 20))]
    pub(crate) max_megabytes: Option<u64>,
    /// How long the import may take, in seconds [default: 60]
    #[arg(long, value_name = "SECONDS", value_parser = value_parser!(u64).range(1..=1_000_000))]
    pub(crate) max_seconds: Option<u64>,
}

#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct CheckArguments {
    /// The model file (RON)
    pub(crate) model: PathBuf,
    #[command(flatten)]
    pub(crate) trust: TrustArguments,
}

#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct LearnArguments {
    /// The model file (RON)
    pub(crate) model: PathBuf,
    #[command(flatten)]
    pub(crate) trust: TrustArguments,
    /// The file for the model with what was learned, written whole or not at all; it may be MODEL
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,
    /// Write what is known to standard output too, as JSON, in the form of `show --json`
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct ShowArguments {
    /// The model file (RON)
    pub(crate) model: PathBuf,
    #[command(flatten)]
    pub(crate) trust: TrustArguments,
    /// Show this entity alone, in full
    #[arg(long, value_name = "ID", value_parser = entity_id)]
    pub(crate) entity: Option<EntityId>,
    /// Write JSON, for programs; what is not known yet is acquired first, in memory
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct ExplainArguments {
    /// The model file (RON)
    pub(crate) model: PathBuf,
    #[command(flatten)]
    pub(crate) trust: TrustArguments,
    /// The entity
    #[arg(long, value_name = "ID", value_parser = entity_id)]
    pub(crate) entity: EntityId,
    /// Write JSON, for programs
    #[arg(long)]
    pub(crate) json: bool,
}

/// Remove what definitions do not need: knots and control points, degrees, equal weights. The shapes and their parameters stay, to
/// a rounding that is proven.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct CleanArguments {
    /// The model file (RON)
    pub(crate) model: PathBuf,
    #[command(flatten)]
    pub(crate) trust: TrustArguments,
    /// Clean this entity alone
    #[arg(long, value_name = "ID", value_parser = entity_id)]
    pub(crate) entity: Option<EntityId>,
    /// The file for the model, written whole or not at all; it may be MODEL
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,
}

/// Remove what definitions hardly need: near knots, and knots and control points that carry less than a tolerance. This changes
/// the shapes, so the tolerance has no default. How far points moved is proven; the originals are kept in the model.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct PurgeArguments {
    /// The model file (RON)
    pub(crate) model: PathBuf,
    #[command(flatten)]
    pub(crate) trust: TrustArguments,
    /// How far points may move from where they are in the original, in the model's unit: giving it is your consent
    #[arg(long, value_name = "T", value_parser = tolerance, allow_negative_numbers = true)]
    pub(crate) tolerance: f64,
    /// Purge this entity alone
    #[arg(long, value_name = "ID", value_parser = entity_id)]
    pub(crate) entity: Option<EntityId>,
    /// The file for the model, written whole or not at all; it may be MODEL
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,
}

/// Take curves apart where they have cusps and loops: the parts, which have none, are added to the model as new entities.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct DecomposeArguments {
    /// The model file (RON)
    pub(crate) model: PathBuf,
    #[command(flatten)]
    pub(crate) trust: TrustArguments,
    /// Take this curve apart alone; without it, every curve
    #[arg(long, value_name = "ID", value_parser = entity_id)]
    pub(crate) entity: Option<EntityId>,
    /// The file for the model, written whole or not at all; it may be MODEL
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,
}

/// Give purged entities their originals again, bit for bit.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct RestoreArguments {
    /// The model file (RON)
    pub(crate) model: PathBuf,
    #[command(flatten)]
    pub(crate) trust: TrustArguments,
    /// Restore this entity alone
    #[arg(long, value_name = "ID", value_parser = entity_id)]
    pub(crate) entity: Option<EntityId>,
    /// Drop the originals instead: the entities stay as they are, for good
    #[arg(long)]
    pub(crate) drop: bool,
    /// The file for the model, written whole or not at all; it may be MODEL
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,
}

/// Make an entity again as it was made, and say how far it is from that.
///
/// The steps of its design intent are run again on the entities of the model; the model stays as it is. The deviation is
/// proven from control points, parameter by parameter, and measured at samples.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct ReplayArguments {
    /// The model file (RON)
    pub(crate) model: PathBuf,
    #[command(flatten)]
    pub(crate) trust: TrustArguments,
    /// The entity
    #[arg(long, value_name = "ID", value_parser = entity_id)]
    pub(crate) entity: EntityId,
    /// Write JSON, for programs
    #[arg(long)]
    pub(crate) json: bool,
}

/// List the entities that an edit of one would touch, in the order in which they would be rebuilt, and why.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct ImpactArguments {
    /// The model file (RON)
    pub(crate) model: PathBuf,
    #[command(flatten)]
    pub(crate) trust: TrustArguments,
    /// The entity
    #[arg(long, value_name = "ID", value_parser = entity_id)]
    pub(crate) entity: EntityId,
    /// Write JSON, for programs
    #[arg(long)]
    pub(crate) json: bool,
}

/// Find all stationary points of the distance from a point to an entity: minima, maxima and saddles.
///
/// Every stationary point is found: each part of the entity is proven to hold none, or belongs to a point or to a continuum that is listed.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct StationaryArguments {
    /// The model file (RON)
    pub(crate) model: PathBuf,
    /// The entity
    #[arg(long, value_name = "ID", value_parser = entity_id)]
    pub(crate) entity: EntityId,
    /// The point from which distances are taken
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    pub(crate) point: DVec3,
    /// Points closer than this are not told apart, in the model's unit; without it, 1e-6 times the entity's size
    #[arg(long, value_name = "T", value_parser = length, allow_negative_numbers = true)]
    pub(crate) tolerance: Option<f64>,
    /// Write JSON, for programs
    #[arg(long)]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) trust: TrustArguments,
}

/// Write a model for other programs: as a STEP file, as triangles, or what is known of its entities as JSON.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, after_long_help = ABOUT_FORMATS)]
pub(crate) struct ExportArguments {
    /// The model file (RON)
    pub(crate) model: PathBuf,
    #[command(flatten)]
    pub(crate) trust: TrustArguments,
    /// The file, written whole or not at all; `-` is standard output
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,
    /// The format; without it, the one that OUT's ending names
    #[arg(long, value_enum)]
    pub(crate) format: Option<Format>,
    /// Write this entity or body alone
    #[arg(long, value_name = "ID", value_parser = entity_id)]
    pub(crate) entity: Option<EntityId>,
    /// OBJ and STL: how far triangles and polylines may be from the shapes, in the model's unit; without it, 1e-3 times the model's size
    #[arg(long, value_name = "E", value_parser = above_zero, allow_negative_numbers = true)]
    pub(crate) chord: Option<f64>,
    /// OBJ and STL: write no more triangles than these, of all faces together; without it, 10 million
    #[arg(long, value_name = "N")]
    pub(crate) most_triangles: Option<NonZeroUsize>,
    /// STL: write text
    #[arg(long)]
    pub(crate) ascii: bool,
}

/// A format that models are exported in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    Step,
    Obj,
    Stl,
    Json,
}

const ABOUT_FORMATS: &str = "\
Formats, by the ending of OUT:
  .step .stp  STEP, AP214: bodies, faces with their edges, free curves, names, colours, the unit. Planes,
              cylinders, cones, spheres and tori that are known and proved are written as such
              (`perpend learn` acquires what is not known), everything else as B-splines
  .obj        triangles of faces and polylines of free curves, an object each, with normals
  .stl        triangles alone, binary (single precision) or with --ascii
  .json       what `perpend show --json` writes

Every point of a triangle or a polyline is proven to be within the chord error of its shape.

Example:
  perpend export bracket.ron -o bracket.stl --chord 0.05

Exit codes: 0 done; 1 an input is wrong (standard error says what, where and how to mend it); 2 wrong usage.";

/// Project points: the nearest point of an entity, or of the whole model, to each.
///
/// POINTS is CSV with a header that names the columns `x,y,z`, or `entity,x,y,z` where each row names its entity by id.
/// With neither that column nor --entity, the nearest entity of the whole model answers. Other columns are carried through.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, after_long_help = ABOUT_ANSWERS)]
pub(crate) struct ProjectArguments {
    /// The model file (RON)
    pub(crate) model: PathBuf,
    #[command(flatten)]
    pub(crate) trust: TrustArguments,
    /// The points (CSV); `-` is standard input
    pub(crate) points: PathBuf,
    /// Project all points onto this entity, or onto the nearest face of this body
    #[arg(long, value_name = "ID", value_parser = entity_id)]
    pub(crate) entity: Option<EntityId>,
    /// Answer with the N nearest entities of the model, one row each, ranked in the column `rank`
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..), conflicts_with_all = ["entity", "within"])]
    pub(crate) k: Option<u32>,
    /// Answer with all entities of the model within this distance, in the model's unit, one row each, ranked in the column `rank`
    #[arg(long, value_name = "R", value_parser = length, allow_negative_numbers = true, conflicts_with = "entity")]
    pub(crate) within: Option<f64>,
    /// The solver; without it, the one that fits the entity
    #[arg(long, value_parser = method())]
    pub(crate) method: Option<Method>,
    /// Worker threads; without it, one for each core. Answers do not depend on it
    #[arg(long, value_name = "N", value_parser = value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// The largest difference between `distance` and `lower_bound` that satisfies, in the model's unit; without it, 1e-9 times
    /// the entity's size
    #[arg(long, value_name = "G", value_parser = length, allow_negative_numbers = true)]
    pub(crate) gap: Option<f64>,
    /// Answer only where the nearest point is at most this far, in the model's unit; other rows get empty answers
    #[arg(long, value_name = "D", value_parser = length, allow_negative_numbers = true)]
    pub(crate) max_distance: Option<f64>,
    /// Add the columns `nx,ny,nz,signed_distance`: a surface's outward unit normal, and the distance with its sign; of a
    /// closed body, negative inside
    #[arg(long)]
    pub(crate) normals: bool,
    /// The file for the answers, written whole or not at all; without it, or with `-`, standard output
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: Option<PathBuf>,
}

/// Make a page that shows a model and how far points lie from it.
///
/// One HTML file that needs nothing else: the surfaces, the points in the colours of their signed deviations, a histogram and tables.
/// POINTS is as for `perpend project`.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub(crate) struct ReportArguments {
    /// The model file (RON)
    pub(crate) model: PathBuf,
    #[command(flatten)]
    pub(crate) trust: TrustArguments,
    /// The points (CSV); `-` is standard input
    pub(crate) points: PathBuf,
    /// The page, written whole or not at all
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,
    /// Measure all points against this entity, and show it alone
    #[arg(long, value_name = "ID", value_parser = entity_id)]
    pub(crate) entity: Option<EntityId>,
    /// Measure all points against this body, and show it alone
    #[arg(long, value_name = "ID", value_parser = entity_id, conflicts_with = "entity")]
    pub(crate) body: Option<EntityId>,
    /// How far triangles may be from the surfaces, in the model's unit; without it, 2e-4 times the size of what is shown
    #[arg(long, value_name = "E", value_parser = above_zero, allow_negative_numbers = true)]
    pub(crate) chord: Option<f64>,
    /// The deviation at which the colours end, in the model's unit; without it, a round number that 98 % of the points are within
    #[arg(long, value_name = "MAX", value_parser = above_zero, allow_negative_numbers = true)]
    pub(crate) scale: Option<f64>,
    /// The most points that are drawn: of more, one of 2, 4, 8, … is. The statistics are always of all points
    #[arg(long, value_name = "N", default_value_t = 200_000, value_parser = value_parser!(u32).range(1..=10_000_000))]
    pub(crate) most_points: u32,
    /// The page's title; without it, the name of POINTS
    #[arg(long, value_name = "T")]
    pub(crate) title: Option<String>,
}

const ABOUT_ANSWERS: &str = "\
Answers, one row for each row of POINTS, in order; with --k and --within, as many as entities answer, the nearest
first, and one with empty answers where none does:
  entity          the entity's id; of a body, that of its nearest face
  x,y,z           the point, as it was written
  u,v             the parameter of the nearest point; v is empty for a curve
  fx,fy,fz        the nearest point: the entity evaluated at (u, v)
  distance        from the point to the nearest point: never below the true distance
  lower_bound     proven: no point of the entity is nearer than this. The true distance lies between
                  lower_bound and distance
  place           interior end edge corner seam pole cusp crease; of a trimmed face also trim-edge and vertex
  multiplicity    unique, tied (another point is as near) or continuum (a whole curve or region is)
  method          the solver that proposed the answer
  rank            with --k and --within: 1 for the nearest entity, 2 for the next, …
  nx,ny,nz,signed_distance
                  with --normals; empty for a curve and where the surface has no normal. The sign is
                  positive on the normal's side; of a closed body, positive outside and negative inside
All lengths are in the model's unit. An input column with the name of an output column comes out as in_NAME.

A bad row keeps its line, with empty answers, and is named on standard error; the other rows are answered, and the
exit code is 1.

Example:
  perpend project bracket.ron scan.csv --entity 7 --normals -o deviations.csv

Exit codes: 0 done; 1 an input is wrong (standard error says what, where and how to mend it); 2 wrong usage.";

fn entity_id(text: &str) -> Result<EntityId, String> {
    text.parse()
        .map(EntityId::new)
        .map_err(|_| "entities are called by id, a whole number: see `perpend show`".to_owned())
}

fn point(text: &str) -> Result<DVec3, String> {
    let numbers: Vec<f64> = text.split(',').filter_map(|number| number.trim().parse().ok()).collect();
    match numbers[..] {
        [x, y, z] if text.split(',').count() == 3 && [x, y, z].iter().all(|x| x.is_finite()) => Ok(DVec3::new(x, y, z)),
        _ => Err("it is three finite numbers with commas between them: 12.5,0,-3".to_owned()),
    }
}

fn length(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(length) if length >= 0.0 && f64::is_finite(length) => Ok(length),
        _ => Err("it is a length in the model's unit: a finite number, at least 0".to_owned()),
    }
}

fn above_zero(text: &str) -> Result<f64, String> {
    match length(text) {
        Ok(length) if length > 0.0 => Ok(length),
        _ => Err("it is a length in the model's unit: a finite number above 0".to_owned()),
    }
}

fn tolerance(text: &str) -> Result<f64, String> {
    match length(text) {
        Ok(length) if length > 0.0 => Ok(length),
        _ => Err("it is how far points may move, in the model's unit: a finite number above 0".to_owned()),
    }
}

fn method() -> impl TypedValueParser<Value = Method> {
    PossibleValuesParser::new(names::METHODS.map(names::method)).map(|name| {
        let known = names::METHODS.into_iter().find(|method| names::method(*method) == name);
        known.expect("no other name passes")
    })
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_command_line_contradicts_itself_nowhere() {
        Arguments::command().debug_assert();
    }
}
