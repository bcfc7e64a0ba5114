//! The body that a garment is made for, and the quality it is draped with.

use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::sync::Arc;
use toile_body::{Description, Figure};
use toile_measure::Measurements;

/// The body that the garment is draped on.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum BodyChoice {
    /// The body that the pattern asks for: a woman of the pattern's size, or an average adult if the pattern
    /// has no sizes.
    #[default]
    OfPattern,
    /// A sample body: the figure with its average measurements, overlaid with the chosen size.
    Sample(Figure),
    /// A body of given measurements.
    Measured {
        /// Figure that the body is grown from.
        figure: Figure,
        /// File that the measurements come from; `None` if they were typed.
        path: Option<PathBuf>,
        /// The measurements (m), (rad).
        measurements: Arc<Measurements>,
    },
    /// A body with its own primitives: from a mannequin file, or edited.
    Shaped {
        /// Description that the body is made from.
        description: Arc<Description>,
        /// Mannequin file; `None` once the body was edited.
        path: Option<PathBuf>,
        /// Measurements that a tape takes on the body (m), (rad).
        measurements: Arc<Measurements>,
    },
    /// A mannequin file that could not be read when the pattern that names it was opened. Until it
    /// can be read, the body is as the pattern says.
    Missing {
        /// The file.
        path: PathBuf,
    },
}

impl BodyChoice {
    /// A few words for screens and reports.
    pub fn words(&self) -> String {
        match self {
            Self::OfPattern => "as the pattern says".into(),
            Self::Sample(figure) => figure_name(*figure).into(),
            Self::Measured { figure, path, .. } => match path {
                Some(path) => format!("{} of {}", figure_name(*figure), path.display()),
                None => format!("{} of typed measurements", figure_name(*figure)),
            },
            Self::Shaped { path, .. } => match path {
                Some(path) => format!("the mannequin of {}", path.display()),
                None => "an edited mannequin".into(),
            },
            Self::Missing { path } => format!(
                "as the pattern says, for want of the mannequin {}",
                path.display()
            ),
        }
    }

    /// Short name of the wearer to print on paper: the name of the sample figure or of the file, else "the
    /// wearer".
    pub fn short_name(&self) -> String {
        let path = match self {
            Self::OfPattern => None,
            Self::Sample(figure) => return figure_name(*figure).into(),
            Self::Measured { path, .. } | Self::Shaped { path, .. } => path.as_ref(),
            Self::Missing { path } => Some(path),
        };
        let file = path.and_then(|path| path.file_name());
        let name = file.map(|name| name.to_string_lossy().into_owned());
        match name.as_deref().and_then(|name| name.split('.').next()) {
            Some(stem) if !stem.is_empty() => stem.to_owned(),
            _ => "the wearer".to_owned(),
        }
    }

    /// Description of a body with its own primitives; `None` for a body that is grown to measurements.
    pub(crate) fn description(&self) -> Option<&Arc<Description>> {
        match self {
            Self::Shaped { description, .. } => Some(description),
            Self::OfPattern | Self::Sample(_) | Self::Measured { .. } | Self::Missing { .. } => {
                None
            }
        }
    }

    /// Whether the body is as the pattern says.
    pub fn is_of_pattern(&self) -> bool {
        matches!(self, Self::OfPattern | Self::Missing { .. })
    }
}

/// The name of a figure on the command line and on screens.
pub(crate) fn figure_name(figure: Figure) -> &'static str {
    figure.name()
}

/// Finds a figure by its name: `woman`, `man`, `mean`, `dress-form`, or `child-2` to `child-14` by age.
pub fn figure_named(name: &str) -> Option<Figure> {
    Figure::ALL
        .into_iter()
        .find(|&figure| figure.name() == name)
}

/// Average measurements of a figure.
pub(crate) fn sample_of(figure: Figure) -> Measurements {
    figure.average()
}

/// Fineness of the garment's mesh, and how near to rest the garment is draped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quality {
    /// Mesh edges of 25 mm, draped to a residual of 1e-2: a quick look.
    Preview,
    /// Mesh edges of 15 mm, draped to a residual of 5e-3: good enough to judge the fit.
    #[default]
    Fit,
    /// Mesh edges of 10 mm, draped to a residual of 1e-3: for the finished picture.
    Final,
}

impl Quality {
    /// All qualities, the coarsest first.
    pub const ALL: [Self; 3] = [Self::Preview, Self::Fit, Self::Final];

    /// Mean edge length of the mesh (m).
    pub fn edge_length(self) -> f64 {
        match self {
            Self::Preview => 0.025,
            Self::Fit => 0.015,
            Self::Final => 0.010,
        }
    }

    /// Mean edge length of a coarser mesh on which the garment is sewn and swings first (m); `None` if the
    /// mesh of [`Self::edge_length`] is coarse enough. A garment with a gathered seam has no coarser mesh.
    pub fn first_edge_length(self) -> Option<f64> {
        match self {
            Self::Preview | Self::Fit => None,
            Self::Final => Some(Self::Preview.edge_length()),
        }
    }

    /// Net force over weight at which the drape counts as at rest (1).
    pub fn residual(self) -> f64 {
        match self {
            Self::Preview => 1e-2,
            Self::Fit => 5e-3,
            Self::Final => 1e-3,
        }
    }

    /// Largest number of steps of the solve for rest; a finer mesh needs more.
    pub fn steps(self) -> usize {
        match self {
            Self::Preview => 400,
            Self::Fit => 600,
            Self::Final => 1000,
        }
    }

    /// Finds a quality by its name on the command line.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|quality| quality.name() == name)
    }

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Preview => "preview",
            Self::Fit => "fit",
            Self::Final => "final",
        }
    }
}
