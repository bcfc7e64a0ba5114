//! The five scaling parameters on the command line.

use clap::Args;
use toile_geometry::Length;
use toile_session::{BodyStretch, Scaling};

/// Five ratios, applied in this order to joints and ellipsoids of a fitted mannequin or of the
/// figure's own.
#[derive(Debug, Args)]
pub struct Stretch {
    /// Stature to bring it to, all in proportion, as in 1700mm.
    #[arg(long, value_name = "LENGTH")]
    pub stature: Option<Length>,
    /// Then depth times this.
    #[arg(long, value_name = "RATIO")]
    pub frontal: Option<f64>,
    /// Then breadth above the spine's origin, arms too, times this.
    #[arg(long, value_name = "RATIO")]
    pub high_lateral: Option<f64>,
    /// Then the height of the spine's origin times this, trunk and legs against each other.
    #[arg(long, value_name = "RATIO")]
    pub spine_origin: Option<f64>,
    /// Then breadth below the spine's origin times this.
    #[arg(long, value_name = "RATIO")]
    pub low_lateral: Option<f64>,
}

impl Stretch {
    /// What is asked for; none where nothing is.
    pub fn asked(&self) -> Option<BodyStretch> {
        let ratios = [
            self.frontal,
            self.high_lateral,
            self.spine_origin,
            self.low_lateral,
        ];
        if self.stature.is_none() && ratios.iter().all(Option::is_none) {
            return None;
        }
        let [frontal, high_lateral, spine_origin, low_lateral] = ratios.map(|r| r.unwrap_or(1.0));
        Some(BodyStretch {
            stature: self.stature.as_ref().map(|length| length.as_metres()),
            ratios: Scaling {
                global: 1.0,
                frontal,
                high_lateral,
                spine_origin,
                low_lateral,
            },
        })
    }
}
