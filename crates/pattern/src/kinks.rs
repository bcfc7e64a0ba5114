//! Kinks: corners at which an edge that runs on across a dart, a pleat or a seam changes its direction.

use crate::evaluate::Evaluation;
use crate::stage::{CORNER, KINK};
use crate::walk::{Joint, Walk};
use crate::{
    Code, Diagnostic, Draft, DraftSeam, OperationId, Panel, Piece, PieceEdge, Place, Role,
    SeamOrigin, Severity,
};
use toile_geometry::{Curve, Vec2};

/// Largest distance between positions that count as equal (m).
const SAME: f64 = 1e-7;

impl Evaluation {
    /// Diagnostics for kinks that are not marked as intended, each once for all copies and halves of a panel.
    pub(crate) fn kinks(&self, draft: &Draft) -> Vec<Diagnostic> {
        let mut found = Vec::new();
        for seam in &draft.seams {
            let is_copy = |origin| matches!(origin, SeamOrigin::Dart { copy, half, .. } if copy != 0 || half != 0);
            let Some(walk) = Walk::new(draft, seam).filter(|_| !is_copy(seam.id)) else {
                continue;
            };
            let joints = walk.joints(self.ease(seam.id));
            for joint in joints.into_iter().flatten() {
                if joint.kink.abs() > KINK {
                    found.extend(self.across(draft, seam, &joint));
                }
            }
        }
        for piece in draft.pieces.iter().filter(|piece| piece.id.copy == 0) {
            found.extend(self.across_pleats(piece));
        }
        found
    }

    fn across(&self, draft: &Draft, seam: &DraftSeam, joint: &Joint) -> Option<Diagnostic> {
        let piece = &draft.pieces[joint.pieces[0]];
        match seam.id {
            SeamOrigin::Dart { dart, .. } => {
                self.across_step((piece, dart), joint.edges.map(|edge| edge.name), joint.kink)
            }
            SeamOrigin::Seam(id) => {
                let is_meant = (0..2).any(|k| {
                    let edges = draft.pieces[joint.pieces[k]].outline.iter();
                    let mut here =
                        edges.filter(|e| (e.curve.start() - joint.corners[k]).norm() < SAME);
                    here.any(|edge| edge.corner.meant)
                });
                (!is_meant).then(|| {
                    Diagnostic::new(
                        Severity::Note,
                        Code::Kink,
                        Place::SeamEnd(id, joint.end),
                        format!(
                            "seam {:?}: {} turns by {:.1} degrees where it runs on across its {}",
                            seam.name,
                            joint.line(self.pattern(), draft),
                            joint.kink.abs().to_degrees(),
                            ["start", "end"][joint.end]
                        ),
                        "draw both edges so that they run on into each other, or say at the corner that it is meant",
                    )
                })
            }
        }
    }

    /// The diagnostic for a kink across a dart, pleat or other operation, between edges with these names.
    fn across_step(
        &self,
        (piece, step): (&Piece, OperationId),
        names: [crate::EdgeName; 2],
        kink: f64,
    ) -> Option<Diagnostic> {
        let pattern = self.pattern();
        let panel: &Panel = pattern.panel(piece.id.panel)?;
        let operation = pattern.operation_of(panel, step)?;
        let is_corner = names[0] != names[1] && kink.abs() > CORNER;
        if operation.meant || is_corner {
            return None;
        }
        let [one, other] = names.map(|name| pattern.edge_name(panel.id, name).unwrap_or("edge"));
        let line = match one == other {
            true => one.to_owned(),
            false => format!("{one} to {other}"),
        };
        let (word, name) = (operation.kind.word(), &operation.name);
        Some(Diagnostic::new(
            Severity::Note,
            Code::Kink,
            Place::Operation(panel.id, step),
            format!(
                "panel {:?}, {word} {name:?}: {line} turns by {:.1} degrees across its mouth once it is closed",
                panel.name,
                kink.abs().to_degrees()
            ),
            "true it, or say that its kink is meant",
        ))
    }

    /// Diagnostics for kinks across the pleats of a piece: after folding, the edges beside an underlay meet.
    fn across_pleats(&self, piece: &Piece) -> Vec<Diagnostic> {
        let is_under = |edge: &PieceEdge| {
            edge.origin.half == 0 && edge.origin.name.role() == Some(Role::Underlay)
        };
        let edges = &piece.outline;
        let count = edges.len();
        let mut found = Vec::new();
        for first in (0..count).filter(|k| is_under(&edges[*k])) {
            let before = &edges[(first + count - 1) % count];
            if is_under(before) {
                continue;
            }
            let mut rest = (1..count).map(|step| &edges[(first + step) % count]);
            let (Some(after), Some(by)) = (
                rest.find(|edge| !is_under(edge)),
                edges[first].origin.name.maker(),
            ) else {
                continue;
            };
            let (Some(from), Some(to)) =
                (direction(&before.curve, 1.0), direction(&after.curve, 0.0))
            else {
                continue;
            };
            let kink = from.perp(&to).atan2(from.dot(&to));
            if kink.abs() > KINK {
                let names = [before.origin.name, after.origin.name];
                found.extend(self.across_step((piece, by), names, kink));
            }
        }
        found
    }
}

fn direction(curve: &Curve, at: f64) -> Option<Vec2> {
    curve.derivative(at).try_normalize(1e-12)
}
