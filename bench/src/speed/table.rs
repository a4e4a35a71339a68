//! The table of goals and what is measured.

use std::fmt::Display;

use perpend_bench::Faults;

/// The time of an evaluation to which the goals belong, in microseconds.
const REFERENCE: f64 = 0.1;

/// What is to be reached.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Goal {
    /// Nothing: the figure is for information.
    None,
    /// A time at most this long on the machine of reference.
    Time(f64),
    /// At most this, on any machine.
    AtMost(f64),
    /// At least this, on any machine.
    AtLeast(f64),
}

/// A table that is printed line by line.
#[derive(Debug)]
pub(crate) struct Table {
    factor: f64,
    reached: usize,
    missed: Vec<String>,
}

impl Table {
    /// A table on a machine on which an evaluation takes so many microseconds.
    pub(crate) fn scaled_by(evaluation: f64) -> Self {
        let factor = evaluation / REFERENCE;
        // where other programs run, too, times are longer, and threads bring less
        if let Ok(load) = std::fs::read_to_string("/proc/loadavg") {
            let load: Vec<&str> = load.split(' ').take(3).collect();
            println!("load of the machine over the last 1, 5 and 15 minutes: {}", load.join(", "));
        }
        println!(
            "a bicubic point with all second derivatives: {evaluation:.4} us; goals that are times: x {factor:.2}"
        );
        println!("{:<74}{:>12}{:>12}{:>12}  reached", "what", "goal", "scaled", "measured");
        Self { factor, reached: 0, missed: Vec::new() }
    }

    /// What follows.
    pub(crate) fn heading(&self, title: impl Display) {
        println!("-- {title}");
    }

    /// A figure beside its goal, both in `unit`.
    pub(crate) fn line(&mut self, what: impl Display, goal: Goal, unit: &str, measured: f64) {
        let with_unit = |x: f64| format!("{}{unit}", figure(x));
        let [stated, scaled, is_reached] = match goal {
            Goal::None => [String::new(), String::new(), String::new()],
            Goal::Time(most) => {
                let scaled = most * self.factor;
                [with_unit(most), with_unit(scaled), self.judge(&what, measured <= scaled)]
            }
            Goal::AtMost(most) => {
                [format!("<={}", with_unit(most)), String::new(), self.judge(&what, measured <= most)]
            }
            Goal::AtLeast(least) => {
                [format!(">={}", with_unit(least)), String::new(), self.judge(&what, measured >= least)]
            }
        };
        println!("{what:<74}{stated:>12}{scaled:>12}{:>12}  {is_reached}", with_unit(measured));
    }

    /// What answers were found guilty of; the goal is nothing.
    pub(crate) fn faults(&mut self, what: impl Display, faults: Faults) {
        let what = format!("{what}: wrong / false / uncertified");
        let is_reached = self.judge(&what, faults.none());
        println!("{what:<74}{:>12}{:>12}{:>12}  {is_reached}", "0 / 0 / 0", "", faults.to_string());
    }

    /// How many goals were reached, and which were not.
    pub(crate) fn close(self) {
        println!("{} of {} goals reached", self.reached, self.reached + self.missed.len());
        for what in self.missed {
            println!("missed: {what}");
        }
    }

    fn judge(&mut self, what: &impl Display, is_reached: bool) -> String {
        if is_reached {
            self.reached += 1;
            "yes".to_owned()
        } else {
            self.missed.push(what.to_string());
            "no".to_owned()
        }
    }
}

/// A number with some three digits.
fn figure(x: f64) -> String {
    match x {
        x if x >= 100.0 || x == x.trunc() => format!("{x:.0} "),
        x if x >= 10.0 => format!("{x:.1} "),
        x => format!("{x:.3} "),
    }
}
