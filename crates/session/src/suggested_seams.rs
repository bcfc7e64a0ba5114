//! Seams suggested for a pattern's edges that have none: listed, accepted, written.
//!
//! # Decided with
//! - [`toile_pattern::plan::suggest_seams`], [`toile_pattern::plan::accept_seams`]: suggestions; seams sewn;
//! - [`crate::write_pattern`]: the pattern written.
//!
//! Options: crate `cli`, `seams_command.rs`.

use crate::fitting::OpenedProject;
use crate::placed_panels::PanelOrigin;
use crate::write_pattern::{format_of, write_pattern};
use crate::{OpenOptions, Project, SessionError};
use serde::Serialize;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use toile_interchange::{Guess, Loss};
use toile_pattern::plan::{
    SeamSuggestions, SewnEdge, SuggestedPair, SuggestedSeam, accept_seams, suggest_seams,
};
use toile_pattern::{Draft, Evaluation, PartId, PieceId, Severity};

/// Suggestions that are accepted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AcceptedSeams {
    /// Those that are certain enough to be sewn unseen.
    Best,
    /// Those with these numbers, from 1.
    Numbers(Vec<usize>),
}

/// How seams are suggested and accepted.
#[derive(Clone, Debug, Default)]
pub struct SeamOptions {
    /// How the input is read.
    pub open: OpenOptions,
    /// Named size whose lengths are compared; `None`: the size that the file keeps, else the base size.
    pub size: Option<String>,
    /// Suggestions to accept, and the file that the pattern is then written to.
    pub accept: Option<(AcceptedSeams, PathBuf)>,
}

/// Suggested seams of a pattern.
#[derive(Clone, Debug, Serialize)]
pub struct SuggestedSeamsReport {
    /// The word `toile-seams`.
    pub format: &'static str,
    /// Version of the report.
    pub version: u32,
    /// Name of the pattern.
    pub pattern: String,
    /// The size whose lengths are compared, if it is one of the pattern's.
    pub size: Option<String>,
    /// The suggestions, the likeliest first.
    pub suggestions: Vec<Suggestion>,
    /// Numbers of the suggestions that were accepted.
    pub accepted: Vec<usize>,
    /// Names of the seams that were made.
    pub seams: Vec<String>,
    /// The edges that are in no seam afterwards.
    pub open: Vec<EdgeOfPiece>,
    /// Files that were written.
    pub files: Vec<PathBuf>,
    /// Decisions on what the input leaves open.
    pub guesses: Vec<Guess>,
    /// Contents of the input, and then of the pattern, that were left out.
    pub lost: Vec<Loss>,
    /// Notes on the reading in words, guesses and losses too, and parts that cannot be drawn.
    pub notes: Vec<String>,
}

/// A suggested seam, with the one on the other side of the wearer.
#[derive(Clone, Debug, Serialize)]
pub struct Suggestion {
    /// Number of the suggestion, from 1.
    pub number: usize,
    /// Cost of the likelier pair (1): the lower, the likelier.
    pub cost: f64,
    /// Whether `best` accepts the suggestion.
    pub best: bool,
    /// The pairs of edges: one, or two that are mirror images of each other.
    pub pairs: Vec<PairOfEdges>,
}

/// Two edges that may be meant to be sewn to each other.
#[derive(Clone, Debug, Serialize)]
pub struct PairOfEdges {
    /// The edges: the start of one is sewn to the end of the other.
    pub edges: [EdgeOfPiece; 2],
    /// Lengths of both edges (mm).
    pub lengths_mm: [f64; 2],
    /// Rank of the second edge among the partners of the first, and of the first among those of the second.
    pub ranks: [usize; 2],
    /// Cost of the pair (1).
    pub cost: f64,
    /// Likelihood that the edges are partners (1).
    pub likelihood: f64,
}

/// An edge of a piece, by names.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct EdgeOfPiece {
    /// Name of the piece.
    pub piece: String,
    /// The panel that the piece is a copy of.
    pub panel: String,
    /// Number of the copy, from 0.
    pub copy: u32,
    /// Half of a folded panel: 0 as drawn; one bit for each fold, set beyond the fold.
    pub half: u8,
    /// Name of the edge.
    pub edge: String,
}

impl std::fmt::Display for EdgeOfPiece {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}", self.piece, self.edge)?;
        if self.half > 0 {
            write!(f, " beyond the fold")?;
        }
        Ok(())
    }
}

/// Suggests seams for a pattern, accepts some if that is asked for, and writes the pattern with them.
///
/// # Errors
/// The input cannot be read; it has no such size; a number is none of the suggestions, or two of the numbers
/// would sew one edge twice; the output cannot be written.
pub fn suggested_seams(
    from: &Path,
    options: &SeamOptions,
) -> Result<SuggestedSeamsReport, SessionError> {
    let OpenedProject {
        mut project,
        mut notes,
        found,
    } = Project::open_from(from, PanelOrigin::Automatic, &options.open)?;
    if options.size.is_some() {
        project.size.clone_from(&options.size);
    }
    project.check_size()?;
    let evaluation = Evaluation::new(&project.pattern, project.drafted_to());
    let (draft, diagnostics) = evaluation.draft();
    let faults = diagnostics
        .iter()
        .filter(|found| found.severity == Severity::Error);
    notes.extend(faults.map(ToString::to_string));
    let suggestions = suggest_seams(&evaluation)?;
    let best = suggestions.best();
    let named = Named {
        evaluation: &evaluation,
        draft: &draft,
    };
    let listed = suggestions.seams.iter().enumerate();
    let mut report = SuggestedSeamsReport {
        format: "toile-seams",
        version: 1,
        pattern: project.pattern.name.clone(),
        size: project.size_name().map(str::to_owned),
        suggestions: listed
            .map(|(k, seam)| named.suggestion(k, seam, &best))
            .collect(),
        accepted: Vec::new(),
        seams: Vec::new(),
        open: suggestions
            .open
            .iter()
            .map(|edge| named.edge(*edge))
            .collect(),
        files: Vec::new(),
        guesses: found.guesses,
        lost: found.losses,
        notes,
    };
    let Some((accept, to)) = &options.accept else {
        return Ok(report);
    };
    let format = format_of(to, None)?;
    let chosen = chosen(accept, &suggestions)?;
    let pairs: Vec<[SewnEdge; 2]> = chosen
        .iter()
        .flat_map(|k| suggestions.seams[*k].edges())
        .collect();
    let (edits, seams) = accept_seams(&evaluation, &pairs)?;
    let sewn = project.edited(&edits)?;
    let written = write_pattern(&sewn, to, format, None)?;
    let names = seams.iter().filter_map(|id| sewn.pattern.seam(*id));
    report.seams = names.map(|seam| seam.name.clone()).collect();
    report.accepted = chosen.iter().map(|k| k + 1).collect();
    let is_open = |edge: &&SewnEdge| !pairs.iter().flatten().any(|sewn| sewn == *edge);
    let open = suggestions.open.iter().filter(is_open);
    report.open = open.map(|edge| named.edge(*edge)).collect();
    report.files = written.files;
    report.lost.extend(written.losses);
    Ok(report)
}

/// Indices of the suggestions that are accepted.
fn chosen(
    accept: &AcceptedSeams,
    suggestions: &SeamSuggestions,
) -> Result<Vec<usize>, SessionError> {
    let numbers = match accept {
        AcceptedSeams::Best => return Ok(suggestions.best()),
        AcceptedSeams::Numbers(numbers) => numbers,
    };
    let count = suggestions.seams.len();
    let distinct: BTreeSet<usize> = numbers.iter().copied().collect();
    let indices = distinct.into_iter().map(|number| match number {
        1.. if number <= count => Ok(number - 1),
        _ => Err(SessionError::Unknown {
            kind: "suggestion",
            name: number.to_string(),
            hint: match count {
                0 => "there is nothing to sew".to_owned(),
                _ => format!("choose numbers from 1 to {count}"),
            },
        }),
    });
    indices.collect()
}

/// Names of pieces and edges.
struct Named<'a> {
    evaluation: &'a Evaluation,
    draft: &'a Draft,
}

impl Named<'_> {
    fn edge(&self, edge: SewnEdge) -> EdgeOfPiece {
        let pattern = self.evaluation.pattern();
        let owner = pattern.owner_of(edge.panel, PartId::Edge(edge.edge));
        let drawn = owner.and_then(|owner| owner.edge(edge.edge));
        let id = PieceId {
            panel: edge.panel,
            copy: edge.copy,
        };
        let piece = self.draft.pieces.iter().find(|piece| piece.id == id);
        EdgeOfPiece {
            piece: piece.map_or_else(String::new, |piece| piece.name.clone()),
            panel: pattern
                .panel(edge.panel)
                .map_or_else(String::new, |p| p.name.clone()),
            copy: edge.copy,
            half: edge.half,
            edge: drawn.map_or_else(String::new, |edge| edge.name.clone()),
        }
    }

    fn pair(&self, pair: &SuggestedPair) -> PairOfEdges {
        PairOfEdges {
            edges: pair.edges.map(|edge| self.edge(edge)),
            lengths_mm: pair.lengths.map(|length| length * 1e3),
            ranks: pair.ranks,
            cost: pair.cost,
            likelihood: pair.likelihood,
        }
    }

    fn suggestion(&self, index: usize, seam: &SuggestedSeam, best: &[usize]) -> Suggestion {
        Suggestion {
            number: index + 1,
            cost: seam.cost(),
            best: best.contains(&index),
            pairs: seam.pairs.iter().map(|pair| self.pair(pair)).collect(),
        }
    }
}
