//! The progress bar.

use std::io::{self, IsTerminal};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A bar on standard error, if that is a terminal and answers do not go to the terminal too.
///
/// `length` is how many bytes there are to read, where that is known.
pub(crate) fn bar(length: Option<u64>, writes_to_file: bool) -> ProgressBar {
    let is_seen = io::stderr().is_terminal() && (writes_to_file || !io::stdout().is_terminal());
    let target = if is_seen { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
    let bar = ProgressBar::with_draw_target(length, target);
    let template = match length {
        Some(_) => "{wide_bar} {percent:>3} %  {msg}, {eta} left",
        None => "{spinner} {msg}, {elapsed}",
    };
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    if is_seen {
        bar.enable_steady_tick(Duration::from_millis(200));
    }
    bar
}
