//! Options that change a body: proportions and the five scaling parameters.

use crate::output::Failure;
use clap::Args;
use toile_geometry::Length;
use toile_session::{
    AskedStance, Axis, BodyStretch, MeshUnit, Scaling, proportions_named, proportions_of_heads,
};

/// How a mesh stands in its file.
#[derive(Debug, Args)]
pub struct StanceOptions {
    /// Axis of the mesh that is up: x, y, z, -x, -y or -z. Default: seen by legs, trunk and head, else y.
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true)]
    up: Option<Axis>,
    /// Axis of the mesh that the person faces along. Default: seen by the feet, else z (-y if z is up).
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true)]
    forward: Option<Axis>,
    /// Unit of the mesh: m, cm, mm, in or ft. Default: told by the person's height.
    #[arg(long, value_name = "UNIT")]
    unit: Option<MeshUnit>,
}

impl StanceOptions {
    /// What is asked for.
    pub fn asked(&self) -> AskedStance {
        AskedStance {
            up: self.up,
            forward: self.forward,
            unit: self.unit,
        }
    }
}

/// A proportion box and five ratios, applied in this order to joints and ellipsoids of a fitted
/// mannequin or of the figure's own.
#[derive(Debug, Args)]
pub struct BodyOptions {
    /// Proportions to bring it to first, at the stature it has: a box of the table (woman, man,
    /// ideal-woman, ideal-man, loomis-1, loomis-3, loomis-5, loomis-10, loomis-15, draftsman-1,
    /// draftsman-8, draftsman-12, by age), or of a file of boxes (JSON, head lengths), as in
    /// boxes.json:tall.
    #[arg(long, value_name = "BOX", conflicts_with_all = ["heads", "mesh"])]
    pub proportions: Option<String>,
    /// Or so many head lengths from crown to chin, legs as in the boxes of the table next to it.
    #[arg(long, value_name = "NUMBER", conflicts_with = "mesh")]
    pub heads: Option<f64>,
    /// Stature to bring it to, all in proportion, as in 1700mm.
    #[arg(long, value_name = "LENGTH", conflicts_with = "mesh")]
    pub stature: Option<Length>,
    /// Then depth times this.
    #[arg(long, value_name = "RATIO", conflicts_with = "mesh")]
    pub frontal: Option<f64>,
    /// Then breadth above the spine's origin, arms too, times this.
    #[arg(long, value_name = "RATIO", conflicts_with = "mesh")]
    pub high_lateral: Option<f64>,
    /// Then the height of the spine's origin times this, trunk and legs against each other.
    #[arg(long, value_name = "RATIO", conflicts_with = "mesh")]
    pub spine_origin: Option<f64>,
    /// Then breadth below the spine's origin times this.
    #[arg(long, value_name = "RATIO", conflicts_with = "mesh")]
    pub low_lateral: Option<f64>,
}

impl BodyOptions {
    /// What is asked for; none where nothing is.
    ///
    /// # Errors
    /// A proportion box that is not there.
    pub fn asked(&self) -> Result<Option<BodyStretch>, Failure> {
        let ratios = [
            self.frontal,
            self.high_lateral,
            self.spine_origin,
            self.low_lateral,
        ];
        let proportions = match (&self.proportions, self.heads) {
            (Some(name), _) => Some(proportions_named(name)?),
            (None, heads) => heads.map(proportions_of_heads),
        };
        let is_one = self.stature.is_none() && ratios.iter().all(Option::is_none);
        if is_one && proportions.is_none() {
            return Ok(None);
        }
        let [frontal, high_lateral, spine_origin, low_lateral] = ratios.map(|r| r.unwrap_or(1.0));
        Ok(Some(BodyStretch {
            proportions,
            stature: self.stature.as_ref().map(|length| length.as_metres()),
            ratios: Scaling {
                global: 1.0,
                frontal,
                high_lateral,
                spine_origin,
                low_lateral,
            },
        }))
    }
}
