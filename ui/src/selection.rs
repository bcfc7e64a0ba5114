//! What is selected or under the pointer. View state: not in the document, not undone.

use crate::drawing::Drawing;
use toile_pattern::{EdgeId, PanelId, PointId};

/// A part of the pattern that can be selected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Selection {
    /// Nothing.
    #[default]
    Nothing,
    /// A point of a panel.
    Point(PanelId, PointId),
    /// An edge of a panel.
    Edge(PanelId, EdgeId),
}

impl Selection {
    /// The panel it is of.
    pub fn panel(self) -> Option<PanelId> {
        match self {
            Self::Nothing => None,
            Self::Point(panel, _) | Self::Edge(panel, _) => Some(panel),
        }
    }

    /// Whether it is still drawn.
    pub fn exists(self, drawing: &Drawing) -> bool {
        let panel = self.panel().and_then(|id| drawing.panel(id));
        match (self, panel) {
            (Self::Nothing, _) => true,
            (Self::Point(_, id), Some(panel)) => panel.point(id).is_some(),
            (Self::Edge(_, id), Some(panel)) => panel.edge(id).is_some(),
            (_, None) => false,
        }
    }

    /// What it is, in words; empty for nothing.
    pub fn words(self, drawing: &Drawing) -> String {
        let Some(panel) = self.panel().and_then(|id| drawing.panel(id)) else {
            return String::new();
        };
        match self {
            Self::Nothing => String::new(),
            Self::Point(_, id) => match panel.point(id) {
                Some(point) => format!("Point {} of {}", point.name, panel.name),
                None => String::new(),
            },
            Self::Edge(_, id) => match panel.edge(id) {
                Some(edge) => format!("Edge {} of {}", edge.name, panel.name),
                None => String::new(),
            },
        }
    }

    /// Seams an edge is sewn by, in words.
    pub fn seam_words(self, drawing: &Drawing) -> String {
        let Self::Edge(panel, edge) = self else {
            return String::new();
        };
        let seams: Vec<String> = drawing
            .seams
            .iter()
            .filter(|seam| {
                seam.stretches
                    .iter()
                    .any(|s| s.panel == panel && s.edge == Some(edge))
            })
            .map(|seam| format!("seam {} ({})", seam.number, seam.name))
            .collect();
        match seams.is_empty() {
            true => "not sewn".into(),
            false => format!("sewn by {}", seams.join(", ")),
        }
    }
}

/// A length in words [m to cm].
pub fn centimetres(metres: f64) -> String {
    format!("{:.1} cm", metres * 100.0)
}
