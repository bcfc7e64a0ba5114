//! Faults of a pattern in each of its sizes.

use crate::outfit::checked;
use crate::{Project, SessionError};
use std::fmt;
use toile_pattern::{Diagnostic, Evaluation, Pattern, SizeSelection};

/// The sizes of a pattern that a selection means, each with its number of garments; a size without a name
/// stands for the pattern as drafted.
///
/// # Errors
/// All sizes of a pattern that has no table of sizes.
pub(crate) fn selected(
    sizes: &SizeSelection,
    pattern: &Pattern,
) -> Result<Vec<(Option<String>, u32)>, SessionError> {
    sizes.of(pattern).ok_or_else(|| {
        let why = "the pattern has no table of sizes: leave the size out";
        SessionError::Conflict(why.to_owned())
    })
}

/// A diagnostic, and the sizes that it was found in.
#[derive(Clone, Debug, PartialEq)]
pub struct SizedDiagnostic {
    /// The diagnostic, in the words of the first of these sizes.
    pub diagnostic: Diagnostic,
    /// Names of the sizes, in the order of the pattern's table; empty for a pattern without sizes.
    pub sizes: Vec<String>,
    /// Whether the diagnostic was found in every size that was checked.
    pub is_everywhere: bool,
}

impl fmt::Display for SizedDiagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.sizes[..], self.is_everywhere) {
            (_, true) | ([], _) => {}
            ([one], _) => write!(f, "size {one}: ")?,
            (several, _) => write!(f, "sizes {}: ", several.join(", "))?,
        }
        self.diagnostic.fmt(f)
    }
}

/// The sizes that a project's pattern is checked in: the chosen size, else all sizes; if a body was chosen
/// and no size, the pattern as drafted to that body.
pub(crate) fn sizes_to_check(project: &Project) -> SizeSelection {
    match (&project.size, &project.body) {
        (Some(size), _) => SizeSelection::one(size),
        (None, body) if body.is_of_pattern() && !project.pattern.sizes.is_empty() => {
            SizeSelection::All
        }
        (None, _) => SizeSelection::Base,
    }
}

/// Diagnostics of a project's pattern in the sizes asked for.
///
/// # Errors
/// A size that the pattern does not have.
pub(crate) fn sized_diagnostics(
    project: &Project,
    sizes: &SizeSelection,
) -> Result<Vec<SizedDiagnostic>, SessionError> {
    let pattern = &project.pattern;
    let names = selected(sizes, pattern)?;
    let looked_at = names.len();
    let mut found: Vec<(SizedDiagnostic, usize)> = Vec::new();
    let mut evaluation = Evaluation::default();
    for (size, _) in names {
        let sized = Project {
            size: size.clone(),
            ..project.clone()
        };
        sized.check_size()?;
        evaluation.update(pattern, sized.drafted_to());
        let (_, diagnostics) = checked(&evaluation);
        gather(&mut found, diagnostics, size.as_deref());
    }
    let told = found.into_iter().map(|(mut sized, times)| {
        sized.is_everywhere = times == looked_at;
        sized
    });
    Ok(told.collect())
}

/// Adds the diagnostics of one more size. Equal faults at one place are merged even if the numbers in their
/// words differ.
fn gather(
    found: &mut Vec<(SizedDiagnostic, usize)>,
    diagnostics: Vec<Diagnostic>,
    size: Option<&str>,
) {
    let mut told = vec![false; found.len()];
    for diagnostic in diagnostics {
        let is_same = |known: &SizedDiagnostic| {
            let known = &known.diagnostic;
            (known.severity, known.code, &known.place)
                == (diagnostic.severity, diagnostic.code, &diagnostic.place)
        };
        let known = (0..told.len()).find(|&k| !told[k] && is_same(&found[k].0));
        let k = known.unwrap_or_else(|| {
            let sized = SizedDiagnostic {
                diagnostic,
                sizes: Vec::new(),
                is_everywhere: false,
            };
            found.push((sized, 0));
            told.push(false);
            told.len() - 1
        });
        told[k] = true;
        found[k].1 += 1;
        found[k].0.sizes.extend(size.map(str::to_owned));
    }
}
