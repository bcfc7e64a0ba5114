//! Diagnostics made from the findings about a cut line.

use crate::names::edge_words;
use crate::piece::CutPiece;
use crate::{CapFault, EdgeIndex, Finding};
use std::collections::BTreeSet;
use toile_pattern::{
    Code, Diagnostic, Draft, EdgeOrigin, Name, NotchId, Panel, Pattern, Place, Severity,
};

/// Shortest length of missing or narrow allowance that is reported (m).
const SHORT: f64 = 0.002;
/// Least amount by which a reported allowance is narrower than asked (m).
const NARROWER: f64 = 5e-4;

/// Diagnostics of the cut lines of a draft, and errors for pieces that have no cut line. A diagnostic of a
/// panel is reported once, not for every copy and half.
pub fn cut_diagnostics(pattern: &Pattern, draft: &Draft) -> Vec<Diagnostic> {
    let mut found = Vec::new();
    for (k, piece) in draft.pieces.iter().enumerate() {
        if piece.id.copy != 0 {
            continue;
        }
        match CutPiece::new((pattern, draft), k, (None, &Default::default())) {
            Ok(cut) => found.extend(cut.diagnostics(pattern)),
            Err(error) => {
                let name = pattern.panel(piece.id.panel).map_or("", |p| &p.name);
                found.push(Diagnostic::new(
                    Severity::Error,
                    Code::NoCutLine,
                    Place::Panel(piece.id.panel),
                    format!("panel {name:?} has no cut line: {error}"),
                    "move what is named there apart",
                ));
            }
        }
    }
    found
}

/// Whether a diagnostic matters to the person who cuts: faults of the cut line, and short or drawn notches.
pub fn concerns_cutter(found: &Diagnostic) -> bool {
    found.severity > Severity::Note || matches!(found.code, Code::NotchShort | Code::NotchDrawn)
}

/// A finding put into words: severity, code, place, text and remedy.
struct Message {
    severity: Severity,
    code: Code,
    place: Place,
    what: String,
    hint: &'static str,
}

fn mm(length: f64) -> String {
    let text = format!("{:.1}", length * 1e3);
    format!("{} mm", text.strip_suffix(".0").unwrap_or(&text))
}

impl CutPiece {
    /// Diagnostics of the piece's cut line, with lengths in millimetres and names of edges. A finding on both
    /// halves of a folded panel is reported once.
    pub fn diagnostics(&self, pattern: &Pattern) -> Vec<Diagnostic> {
        let id = self.id.panel;
        let Some(panel) = pattern.panel(id) else {
            return Vec::new();
        };
        let mut seen = BTreeSet::new();
        let mut found = Vec::new();
        let lineage = pattern.lineage(panel);
        for message in self
            .findings
            .iter()
            .filter_map(|f| self.message(&lineage, f))
        {
            if !seen.insert(message.what.clone()) {
                continue;
            }
            let text = format!("panel {:?}: {}", panel.name, message.what);
            found.push(Diagnostic::new(
                message.severity,
                message.code,
                message.place,
                text,
                message.hint,
            ));
        }
        found
    }

    fn message(&self, lineage: &[&Panel], finding: &Finding) -> Option<Message> {
        let words = |index: EdgeIndex| match self.edge(index) {
            Some(origin) => edge_words(lineage, origin),
            None => "an edge".to_owned(),
        };
        let message = |severity, code, at: Option<EdgeIndex>, what, hint| Message {
            severity,
            code,
            place: self.place(at.and_then(|index| self.edge(index))),
            what,
            hint,
        };
        Some(match finding {
            Finding::Swallowed {
                inner_corner: true, ..
            } => return None,
            Finding::Swallowed { edge, span, .. } => {
                let length = span[1] - span[0];
                if length < SHORT {
                    return None;
                }
                message(
                    Severity::Note,
                    Code::AllowanceSwallowed,
                    Some(*edge),
                    format!(
                        "along {} of {} the seam allowance runs into other cloth: it is wider there",
                        mm(length),
                        words(*edge)
                    ),
                    "lessen the allowance, and clip it to the seam after sewing",
                )
            }
            Finding::Narrow { edge, span, least } => {
                let asked = self.width(*edge);
                let length = span[1] - span[0];
                if length < SHORT || asked.is_some_and(|asked| asked - least < NARROWER) {
                    return None;
                }
                message(
                    Severity::Note,
                    Code::AllowanceNarrow,
                    Some(*edge),
                    format!(
                        "along {} of {} the seam allowance is only {} wide, as its corner is cut",
                        mm(length),
                        words(*edge),
                        mm(*least)
                    ),
                    "choose another corner there if that is too narrow to sew",
                )
            }
            Finding::CutOff {
                corner,
                asked,
                kept,
            } => message(
                Severity::Warning,
                Code::SharpCorner,
                Some(*corner),
                format!(
                    "{} is too sharp for its seam allowance, which would reach {} beyond it: it is cut off at {}",
                    self.corner_words(lineage, *corner),
                    mm(*asked),
                    mm(*kept)
                ),
                "blunt the corner, or lessen the seam allowance of its edges",
            ),
            Finding::Mitred { corner, asked } => message(
                Severity::Note,
                Code::BluntCorner,
                Some(*corner),
                format!(
                    "{} is too blunt for its kind, which would reach {} beyond it: both cut lines run on until they meet",
                    self.corner_words(lineage, *corner),
                    mm(*asked)
                ),
                "give the corner as a mitre",
            ),
            Finding::SlitShut {
                edges,
                depth,
                length,
                ..
            } => message(
                Severity::Warning,
                Code::SlitShut,
                Some(edges[0]),
                format!(
                    "the slit between {} and {} is not cut open: the seam allowances of its sides meet, {} of seam line up to {} deep",
                    words(edges[0]),
                    words(edges[1]),
                    mm(*length),
                    mm(*depth)
                ),
                "widen the slit, or lessen the seam allowance of its sides",
            ),
            Finding::BayShut { area, .. } => message(
                Severity::Warning,
                Code::SlitShut,
                None,
                format!(
                    "the seam allowances round a bay of the outline meet at its mouth and leave a hole of {:.1} cm2",
                    area * 1e4
                ),
                "widen the mouth, or lessen the seam allowance there",
            ),
            Finding::HoleShut { hole, parts } => {
                let edge = EdgeIndex {
                    ring: hole + 1,
                    edge: 0,
                };
                let what = match parts {
                    0 => "is filled by its seam allowance and not cut".to_owned(),
                    n => format!("falls into {n} parts, as its seam allowances meet"),
                };
                let line = match self.edge(edge).map(|edge| edge.name) {
                    Some(Name::Drawn(id)) => lineage.iter().find_map(|own| own.line_of(id)),
                    _ => None,
                };
                let line = line.map_or("a hole".to_owned(), |line| format!("line {:?}", line.name));
                message(
                    Severity::Warning,
                    Code::HoleShut,
                    Some(edge),
                    format!("{line} {what}"),
                    "lessen its seam allowance, or make it wider",
                )
            }
            Finding::StraightCap { dart, fault } => {
                let leg = self.darts.get(*dart).copied();
                let name = leg.map_or_else(|| "a dart".to_owned(), |leg| edge_words(lineage, leg));
                Message {
                    severity: Severity::Note,
                    code: Code::StraightDart,
                    place: self.place(leg),
                    what: format!(
                        "{name} is cut straight across its mouth: {}",
                        fault_words(*fault)
                    ),
                    hint: "fold the dart before cutting there, or press it to the other side",
                }
            }
            Finding::NotchesShort { notches, depth } => self.notches_message(
                lineage,
                (Code::NotchShort, notches),
                (
                    &format!(
                        "cut only {} deep, as the seam allowance is narrow",
                        mm(*depth)
                    ),
                    "widen the seam allowance if that is too little to see",
                ),
            ),
            Finding::NotchesDrawn { notches } => self.notches_message(
                lineage,
                (Code::NotchDrawn, notches),
                (
                    "drawn on the seam line and not cut, as there is no seam allowance",
                    "mark the cloth there, or give the edge a seam allowance",
                ),
            ),
        })
    }

    /// Message about one or several notches.
    fn notches_message(
        &self,
        lineage: &[&Panel],
        (code, notches): (Code, &[NotchId]),
        (done, hint): (&str, &'static str),
    ) -> Message {
        let panel = self.id.panel;
        let name = |id: &NotchId| match lineage.iter().find_map(|own| own.notch(*id)) {
            Some(notch) => format!("{:?}", notch.name),
            None => id.to_string(),
        };
        let names: Vec<String> = notches.iter().map(name).collect();
        let what = match &names[..] {
            [only] => format!("notch {only} is {done}"),
            all => format!("notches {} are {done}", all.join(", ")),
        };
        Message {
            severity: Severity::Note,
            code,
            place: notches
                .first()
                .map_or(Place::Panel(panel), |id| Place::Notch(panel, *id)),
            what,
            hint,
        }
    }

    /// Diagnostic place of an edge, or of the operation that made the edge; the panel if `edge` is `None`.
    fn place(&self, edge: Option<EdgeOrigin>) -> Place {
        let panel = self.id.panel;
        match edge.map(|edge| edge.name) {
            Some(Name::Drawn(edge)) => Place::Edge(panel, edge),
            Some(Name::Made { by, .. }) => Place::Operation(panel, by),
            None => Place::Panel(panel),
        }
    }

    /// Words for the corner at the start of an edge: the names of the two edges that meet there.
    fn corner_words(&self, lineage: &[&Panel], corner: EdgeIndex) -> String {
        let count = self.names.get(corner.ring).map_or(1, Vec::len);
        let before = EdgeIndex {
            edge: (corner.edge + count - 1) % count,
            ..corner
        };
        let (Some(one), Some(other)) = (self.edge(before), self.edge(corner)) else {
            return "a corner".to_owned();
        };
        let [mut a, mut b] = [one, other].map(|origin| edge_words(lineage, origin));
        if a > b {
            std::mem::swap(&mut a, &mut b);
        }
        match a == b {
            true if one != other => format!("the corner of {a} at the fold"),
            true => format!("a corner of {a}"),
            false => format!("the corner of {a} and {b}"),
        }
    }
}

fn fault_words(fault: CapFault) -> &'static str {
    match fault {
        CapFault::NoNeighbour => "the edge it is pressed towards is a leg of another dart",
        CapFault::NoMeeting => "its leg runs along the allowance of the edge beside it",
        CapFault::TooShort => "the edge beside it is too short for a dart of its width",
        CapFault::Crossing => "the cloth at its mouth would cross itself",
    }
}
