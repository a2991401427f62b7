//! The paths that a study names: every key of one is resolved here.
//!
//! A study that is handed on reads and writes nothing outside of its folder, by whatever path or link, unless it says so
//! (`files_outside = true`). Tables of measured values are the exception: they hold nothing but numbers of a column, and often lie
//! beside several studies.

use std::ops::Range;
use std::path::{Component, Path, PathBuf};

use super::at::At;
use super::context::{Context, Fault};
use super::error::Problem;

/// Where a path may lead.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Reach {
    /// Not out of the study's folder.
    Inside,
    Anywhere,
}

/// The folder of the study, absolute: programs run elsewhere.
pub(super) fn folder(context: &Context<'_>) -> PathBuf {
    let folder = context.path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let absolute = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    // Without the "." that stood for here.
    absolute.components().collect()
}

/// The path that stands at a key, relative to the study. It need not exist.
///
/// # Errors
/// [`Problem`] if it leads further than `reach`.
pub(super) fn resolve(context: &Context<'_>, typed: &At<String>, reach: Reach) -> Result<PathBuf, Fault> {
    let folder = folder(context);
    let path = folder.join(typed.get_ref());
    let is_inside = || Some(real_path(&path)?.starts_with(folder.canonicalize().ok()?));
    if reach == Reach::Anywhere || is_inside().unwrap_or(false) {
        return Ok(path);
    }
    Err(outside(context, typed.span(), &path, "out of the study's folder"))
}

/// Refuses the name of a file that a run writes where it leads out of the directory of the run.
///
/// # Errors
/// As for [`resolve`].
pub(super) fn refuse_outside_of_run(
    context: &Context<'_>,
    span: Range<usize>,
    file: &str,
    reach: Reach,
) -> Result<(), Fault> {
    let is_below = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
    if reach == Reach::Anywhere || Path::new(file).components().all(is_below) {
        return Ok(());
    }
    Err(outside(context, span, Path::new(file), "out of the directory of a run"))
}

fn outside(context: &Context<'_>, span: Range<usize>, path: &Path, place: &str) -> Fault {
    let help = "name one inside, or add files_outside = true to [command]";
    context.fault(span, Problem::with_help(format!("{}: the path leads {place}", path.display()), help))
}

/// The path without links; of what does not exist yet, that of the folder it will be made in. `None` where this is unknown.
fn real_path(path: &Path) -> Option<PathBuf> {
    if let Ok(real) = path.canonicalize() {
        return Some(real);
    }
    // A link to what does not exist.
    if path.symlink_metadata().is_ok() {
        return None;
    }
    // Neither has a path that ends in "..".
    Some(real_path(path.parent()?)?.join(path.file_name()?))
}
