//! Which panes of the window and which overlays of the pattern are visible.

use super::tab::Tab;
use crate::canvas::selection::Selection;
use crate::tables::FabricTable;
use crate::tables::WearerTable;
use serde::{Deserialize, Serialize};
use toile_pattern::VariableId;

/// Visibility of the parts of the window that can be hidden.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Panes {
    /// The 3D view.
    pub garment: bool,
    /// The marker.
    pub marker: bool,
    /// Tables of measurements, variables, sizes, history.
    pub tables: bool,
    /// Whether the tables stand beside the pattern, under the garment, rather than below the pattern.
    /// `None` until the user moves the tables: then the width of the window decides.
    pub tables_beside: Option<bool>,
    /// Names of the tools beside their icons.
    pub tool_names: bool,
    /// The list of findings.
    pub findings: bool,
    /// Cut lines of panels.
    pub allowances: bool,
    /// Rulers.
    pub rulers: bool,
    /// Guides.
    pub guides: bool,
}

impl Default for Panes {
    fn default() -> Self {
        Self {
            garment: true,
            marker: false,
            tables: false,
            tables_beside: None,
            tool_names: false,
            findings: false,
            allowances: true,
            rulers: true,
            guides: true,
        }
    }
}

/// The table on show, and the texts typed into it.
#[derive(Default)]
pub struct Tables {
    pub tab: Tab,
    pub new_variable: String,
    pub new_measurement: String,
    /// Whether a variable was added that must be scrolled into view.
    pub added: bool,
    /// A measurement whose first value is typed next.
    pub entered_measurement: Option<String>,
    pub fabric: FabricTable,
    pub wearer: WearerTable,
    /// A variable whose number is typed next.
    pub entered_variable: Option<VariableId>,
}

impl Tables {
    /// Least useful height of the table on show (pixels).
    pub fn least_height(&self) -> f32 {
        match self.tab {
            Tab::Fabric | Tab::Wearer => 290.0,
            Tab::WornWith => 180.0,
            Tab::Measurements | Tab::Variables | Tab::Grading | Tab::History | Tab::Pattern => 80.0,
        }
    }

    /// Discards the typed texts when another document is opened.
    pub fn forget_typed(&mut self) {
        *self = Self {
            tab: self.tab,
            ..Self::default()
        };
    }
}

/// Corner of the canvas in which the inspector stands, and the selection that the corner was chosen for.
#[derive(Default)]
pub(crate) struct InspectorPlace {
    /// Selection that the corner was chosen for.
    pub told: Selection,
    /// Whether the inspector stands in the left corner.
    pub is_left: bool,
}
