//! Makes markers of drafts: one for each fabric and each roll of it.
//!
//! # Decided with
//! - [`crate::pieces`] (`check_count`, `check_piece_names`): pieces refused beforehand;
//! - [`crate::starting_marker::check_locks`], [`crate::options::NestOptions::plan`]: locks, fabric and rolls
//!   refused;
//! - [`toile_nesting::NestingError`], [`crate::error::MarkerError`]: jobs that are refused; in words;
//! - [`toile_nesting::Budget`], [`crate::progress::SearchWatcher`]: when it stops;
//! - [`crate::job::FabricJob::progress`], [`toile_nesting::Marker`], [`crate::summary::MarkerSummary`]: use
//!   of the fabric meanwhile, and of the result;
//! - [`toile_nesting::make_markers_on_rolls`]: several rolls filled one after another.
//!
//! By hand: `progress` computes the use of the fabric a second time. After a stop the other fabrics get one
//! evaluation. Shown by crate `interchange` (`marker_drawing.rs`, `marker_report.rs`) and crate `cli`
//! (`output.rs`).

use crate::finished_marker::FinishedMarker;
use crate::flaws::check_given;
use crate::job::FabricJob;
use crate::pieces::{Garments, PieceToCut, pieces_to_cut};
use crate::progress::{SearchProgress, SearchWatcher};
use crate::starting_marker::{check_locks, check_names};
use crate::{MarkerError, NestOptions};
use std::sync::atomic::{AtomicBool, Ordering};
use toile_interchange::ANY_NAME;
use toile_nesting::{Budget, NestingError};
use toile_pattern::Fabric;

/// Lays all pieces of one or more drafts, each fabric on markers of its own. Fabrics come in the order in
/// which pieces first name them.
///
/// # Errors
/// Pieces or options that cannot be laid, in words, reported before the search begins; the search was stopped
/// and its best marker is not to be kept.
pub fn lay(
    garments: &[Garments<'_>],
    options: &NestOptions,
    follow: &mut SearchWatcher<'_>,
) -> Result<Vec<FinishedMarker>, MarkerError> {
    let mut groups: Vec<(String, Vec<PieceToCut>)> = Vec::new();
    for to_cut in pieces_to_cut(garments, options, None)? {
        match groups.iter_mut().find(|g| g.0 == to_cut.fabric) {
            Some(group) => group.1.push(to_cut),
            None => groups.push((to_cut.fabric.clone(), vec![to_cut])),
        }
    }
    if groups.is_empty() {
        return Err(NestingError::NoItems.into());
    }
    check_fabric_names(&groups, options)?;
    let names: Vec<&str> = groups.iter().map(|group| group.0.as_str()).collect();
    check_given(&options.flaws, &names)?;
    let fabrics = || garments.iter().flat_map(|g| &g.draft.fabrics);
    check_names(&options.from, &options.locked)?;
    // Every error in the input is reported before the search begins.
    let jobs: Vec<FabricJob> = groups
        .iter()
        .map(|(name, to_cut)| {
            let own: Option<&Fabric> = fabrics().find(|f| f.name == *name);
            FabricJob::new((name, to_cut), own, options)
        })
        .collect::<Result<_, _>>()?;
    check_locks(jobs.iter().flat_map(|job| &job.items), &options.locked)?;
    let count = jobs.len() as f64;
    let flag = follow.stop.clone();
    let mut finished_markers = Vec::new();
    let mut stopped = false;
    for (k, job) in jobs.iter().enumerate() {
        let from = k as f64 / count;
        let mut part = |progress: SearchProgress| {
            let done = from + progress.done / count;
            stopped |= !(follow.report)(&SearchProgress { done, ..progress });
            !stopped
        };
        let laid = match part(SearchProgress::default()) {
            true => job.lay(options, (&flag, &mut part)),
            false => Err(MarkerError::Cancelled),
        };
        stopped |= flag.load(Ordering::Relaxed);
        if stopped && !options.keep_best {
            return Err(MarkerError::Cancelled);
        }
        finished_markers.extend(match laid {
            // Earlier fabrics are done: this one gets the first marker found.
            Err(MarkerError::Cancelled) if !finished_markers.is_empty() => {
                stopped = true;
                let mut shortly = options.clone();
                shortly.budget = Budget::Evaluations(1);
                job.lay(&shortly, (&AtomicBool::new(false), &mut |_| true))?
            }
            laid => laid?,
        });
    }
    if stopped {
        for finished in &mut finished_markers {
            finished
                .facts
                .notes
                .push("stopped early: the best so far".to_owned());
        }
    }
    Ok(finished_markers)
}

/// Refuses settings of a fabric that nothing is cut from.
fn check_fabric_names(
    groups: &[(String, Vec<PieceToCut>)],
    options: &NestOptions,
) -> Result<(), MarkerError> {
    let known = |name: &str| name == ANY_NAME || groups.iter().any(|g| g.0 == name);
    let given = options.settings.fabrics.keys();
    match given.into_iter().find(|name| !known(name)) {
        None => Ok(()),
        Some(name) => {
            let names: Vec<&str> = groups.iter().map(|g| g.0.as_str()).collect();
            Err(MarkerError::Unknown {
                kind: "fabric",
                name: name.clone(),
                hint: format!("pieces are cut from: {}", names.join(", ")),
            })
        }
    }
}
