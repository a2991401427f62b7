//! The paths that a study names: all of them are resolved here.
//!
//! A study reads and writes nothing outside its folder, by any path or link, unless it says so
//! (`files_outside = true`). Tables of measured values are the exception: they hold only numbers of a column, and are
//! often next to several studies.

use std::ops::Range;
use std::path::{Component, Path, PathBuf};

use super::at::At;
use super::context::{Context, Fault};
use super::error::Problem;

/// How far a path may lead.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Reach {
    /// Not out of the study's folder.
    Inside,
    Anywhere,
}

/// Returns the folder of the study, absolute: programs run elsewhere.
pub(super) fn folder(context: &Context<'_>) -> PathBuf {
    let folder = context.path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let absolute = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    // Without the "." for the current folder.
    absolute.components().collect()
}

/// Resolves the path of a key, relative to the study. It need not exist.
///
/// # Errors
/// [`Problem`] if it is outside `reach`.
pub(super) fn resolve(context: &Context<'_>, typed: &At<String>, reach: Reach) -> Result<PathBuf, Fault> {
    let folder = folder(context);
    let path = folder.join(typed.get_ref());
    let is_inside = || Some(real_path(&path)?.starts_with(folder.canonicalize().ok()?));
    if reach == Reach::Anywhere || is_inside().unwrap_or(false) {
        return Ok(path);
    }
    Err(outside(context, typed.span(), &path, "outside the study's folder"))
}

/// Refuses the name of a file that a run writes if it is outside the directory of the run.
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
    Err(outside(context, span, Path::new(file), "outside the directory of a run"))
}

fn outside(context: &Context<'_>, span: Range<usize>, path: &Path, place: &str) -> Fault {
    let help = "name one inside, or add files_outside = true to [command]";
    context.fault(span, Problem::with_help(format!("{}: the path leads {place}", path.display()), help))
}

/// Returns the path without links; for a missing file, that of its future folder. `None` if this is unknown.
fn real_path(path: &Path) -> Option<PathBuf> {
    if let Ok(real) = path.canonicalize() {
        return Some(real);
    }
    // A link to a missing file.
    if path.symlink_metadata().is_ok() {
        return None;
    }
    // Neither has a path that ends in "..".
    Some(real_path(path.parent()?)?.join(path.file_name()?))
}
