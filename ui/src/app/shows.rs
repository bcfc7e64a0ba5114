//! What of the window is on show.

/// Parts of the window that can be hidden.
#[derive(Clone, Copy, Debug)]
pub struct Shows {
    /// The 3D view.
    pub garment: bool,
    /// The marker.
    pub marker: bool,
    /// Measurements, variables, sizes, history.
    pub tables: bool,
    /// What is found wrong.
    pub findings: bool,
}

/// Which table is on show, and what is typed into it.
#[derive(Default)]
pub struct Tables {
    pub tab: Tab,
    pub new_variable: String,
    pub new_measurement: String,
}

#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub enum Tab {
    #[default]
    Measurements,
    Variables,
    History,
}
