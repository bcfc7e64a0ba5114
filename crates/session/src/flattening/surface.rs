//! The surface that a panel is made of: a mesh of a file, or the skin of a body.

use crate::bodies::body_of;
use crate::input::read_file;
use crate::mannequin_source::MannequinSource;
use crate::mesh_file::open_mesh;
use crate::{BodyChoice, Project, SessionError};
use std::path::{Path, PathBuf};
use toile_body::{Figure, Mannequin};
use toile_geometry::TriangleMesh;
use toile_interchange::FileKind;

/// The surface that a panel is made of.
#[derive(Clone, Debug, PartialEq)]
pub enum SurfaceSource {
    /// A mesh of a file (OBJ or PLY), as it stands in the file (m).
    Mesh(PathBuf),
    /// A body: a figure with its average measurements, or of a file of measurements, a mannequin file, or a mesh.
    Body {
        /// Figure that the body is grown from.
        figure: Option<Figure>,
        /// File of the body.
        path: Option<PathBuf>,
    },
}

impl SurfaceSource {
    /// The file, or the name of the figure, for messages.
    pub(super) fn place(&self) -> PathBuf {
        match self {
            Self::Mesh(path)
            | Self::Body {
                path: Some(path), ..
            } => path.clone(),
            Self::Body { figure, path: None } => figure.map_or("the body", Figure::name).into(),
        }
    }

    /// Makes or reads the surface.
    ///
    /// # Errors
    /// The file cannot be read, or no body can be made from it.
    pub(super) fn open(&self) -> Result<OpenedSurface, SessionError> {
        let (figure, path) = match self {
            Self::Mesh(path) => return OpenedSurface::of_mesh(path),
            Self::Body { figure, path } => (*figure, path.as_deref()),
        };
        let (body, notes) = match path {
            Some(path) if figure.is_none() => {
                let kind = FileKind::of(&read_file(path)?);
                if matches!(kind, Some(FileKind::Obj | FileKind::Ply)) {
                    return OpenedSurface::of_mesh(path);
                }
                body_of(figure, path)?
            }
            Some(path) => body_of(figure, path)?,
            None => {
                let figure = figure.unwrap_or(Figure::Mean);
                (BodyChoice::Sample(figure), Vec::new())
            }
        };
        let project = Project {
            body,
            ..Project::default()
        };
        let mannequin = MannequinSource::of(&project).make()?;
        Ok(OpenedSurface {
            mesh: mannequin.skin().clone(),
            mannequin: Some(mannequin),
            notes,
        })
    }
}

/// A surface that was made or read.
pub(super) struct OpenedSurface {
    /// The surface.
    pub mesh: TriangleMesh,
    /// The body, with its landmarks, if it is one.
    pub mannequin: Option<Mannequin>,
    /// Notes for the user.
    pub notes: Vec<String>,
}

impl OpenedSurface {
    fn of_mesh(path: &Path) -> Result<Self, SessionError> {
        let opened = open_mesh(path)?;
        Ok(Self {
            mesh: opened.mesh,
            mannequin: None,
            notes: opened.notes,
        })
    }
}
