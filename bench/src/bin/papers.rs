//! The tables of the papers, measured anew: `papers [selimovic|few|piegl|xu]`, all of them without a name; with `--quick`, Piegl's last table is shorter.
//!
//! The test corpora are read from `tests/data`, or from the folder that the environment variable `PERPEND_CORPUS` names.

#![allow(clippy::print_stdout, reason = "a benchmark prints its tables")]

#[path = "../papers/few.rs"]
mod few;
#[path = "../papers/piegl/mod.rs"]
mod piegl;
#[path = "../papers/selimovic.rs"]
mod selimovic;
#[path = "../papers/xu.rs"]
mod xu;

use perpend_bench::Failure;

/// Prints the tables of a paper.
type Print = fn() -> Result<(), Failure>;

/// The papers by their names on the command line; `few` is a question that Selimovic's raises: is it the choice for a few queries?
const PAPERS: [(&str, Print); 4] =
    [("selimovic", selimovic::print), ("few", few::print), ("piegl", piegl::print), ("xu", xu::print)];

fn main() -> Result<(), Failure> {
    let wanted: Vec<String> = std::env::args().skip(1).filter(|a| a != "--quick").collect();
    if let [first, rest @ ..] = wanted.as_slice()
        && first == "piegl-run"
    {
        return piegl::run(rest);
    }
    if let Some(unknown) = wanted.iter().find(|name| PAPERS.iter().all(|(paper, _)| paper != name)) {
        let known: Vec<&str> = PAPERS.iter().map(|(paper, _)| *paper).collect();
        return Err(format!("no paper is called {unknown}; usage: papers [{}]", known.join("|")).into());
    }
    for (paper, print) in PAPERS {
        if wanted.is_empty() || wanted.iter().any(|name| name == paper) {
            print()?;
        }
    }
    Ok(())
}
