//! The one ground state.

use crate::choice::sample_of;
use crate::{BodyChoice, FabricChoice, Quality, SessionError};
use std::path::PathBuf;
use std::sync::Arc;
use toile_body::Figure;
use toile_measure::Measurements;
use toile_pattern::{Diagnostic, Edit, EditError, Pattern, Severity};

/// Everything a person decides. Cloning is cheap.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Project {
    /// The pattern.
    pub pattern: Arc<Pattern>,
    /// The file it was read from or last saved to.
    pub source: Option<PathBuf>,
    /// Whose body it is draped on.
    pub body: BodyChoice,
    /// Named size of the pattern; nothing means its base size, or the measured body.
    pub size: Option<String>,
    /// A fabric that takes the place of every panel's.
    pub fabric: Option<FabricChoice>,
    /// Width of the fabric [m]; nothing means the fabric's own.
    pub width: Option<f64>,
    /// How finely it is meshed and draped.
    pub quality: Quality,
    /// Layer it is worn in among `others`: larger numbers lie farther out.
    pub layer: u16,
    /// Garments worn with it.
    pub others: Vec<WornGarment>,
}

/// A garment worn with that of the project's pattern, made in the same size, fabric and quality.
#[derive(Clone, Debug, PartialEq)]
pub struct WornGarment {
    /// Its pattern.
    pub pattern: Arc<Pattern>,
    /// The file it was read from.
    pub source: PathBuf,
    /// Its layer.
    pub layer: u16,
}

impl Project {
    /// The project with edits made in its pattern, all or none.
    pub(crate) fn edited(&self, edits: &[Edit]) -> Result<Self, EditError> {
        let mut pattern = (*self.pattern).clone();
        pattern.apply(edits)?;
        let mut next = Self {
            pattern: Arc::new(pattern),
            ..self.clone()
        };
        // A choice of something that is gone would mean nothing.
        if next.check_size().is_err() {
            next.size = None;
        }
        let chosen = next.fabric.as_ref();
        if chosen.is_some_and(|choice| choice.fabric(&next.pattern).is_none()) {
            next.fabric = None;
        }
        Ok(next)
    }

    /// The figure the mannequin is grown from.
    pub fn figure(&self) -> Figure {
        match &self.body {
            BodyChoice::OfPattern if self.pattern.sizes.is_empty() => Figure::Mean,
            BodyChoice::OfPattern => Figure::Woman,
            BodyChoice::Sample(figure) | BodyChoice::Measured { figure, .. } => *figure,
            BodyChoice::Shaped { description, .. } => description.figure,
        }
    }

    /// Name of the size the pattern is drafted to, if it is one of its own.
    pub fn size_name(&self) -> Option<&str> {
        match (&self.size, &self.body) {
            (Some(size), _) => Some(size),
            (None, BodyChoice::OfPattern) => self.pattern.base().map(|size| &*size.name),
            (None, _) => None,
        }
    }

    /// Refuses a size the pattern does not have, or one worn with it that has a table of sizes.
    pub(crate) fn check_size(&self) -> Result<(), SessionError> {
        let Some(name) = &self.size else {
            return Ok(());
        };
        let refuse = |pattern: &Pattern, whose: &str| {
            let names: Vec<&str> = pattern.sizes.iter().map(|s| &*s.name).collect();
            Err(SessionError::Unknown {
                kind: "size",
                name: name.clone(),
                hint: match names.is_empty() {
                    true => "the pattern has no table of sizes: leave the size out".into(),
                    false => format!("choose one of {}{whose}", names.join(", ")),
                },
            })
        };
        if self.pattern.size(name).is_none() {
            return refuse(&self.pattern, "");
        }
        let lacks = |worn: &&WornGarment| {
            !worn.pattern.sizes.is_empty() && worn.pattern.size(name).is_none()
        };
        match self.others.iter().find(lacks) {
            Some(worn) => refuse(
                &worn.pattern,
                &format!(", those of {}", worn.source.display()),
            ),
            None => Ok(()),
        }
    }

    /// Refuses a pattern with faults that keep the garment from being made.
    pub(crate) fn refuse_faults(&self, found: &[Diagnostic]) -> Result<(), SessionError> {
        let errors = found.iter().filter(|d| d.severity == Severity::Error);
        let faults: Vec<String> = errors.map(ToString::to_string).collect();
        if faults.is_empty() {
            return Ok(());
        }
        Err(SessionError::Faults {
            source_name: self.source_name(),
            faults,
        })
    }

    /// The pattern's file, or its name.
    pub(crate) fn source_name(&self) -> String {
        match &self.source {
            Some(path) => path.display().to_string(),
            None => self.pattern.name.clone(),
        }
    }

    fn named_size(&self) -> Option<&Measurements> {
        self.pattern.size(self.size.as_deref()?)
    }

    /// The measurements of the mannequin [m], [rad]: those of the file; else those of the named
    /// size, or of the pattern's base size where no body was chosen; else the figure's averages.
    /// What they leave out is predicted from them.
    pub fn wearer(&self) -> Measurements {
        let size = match &self.body {
            BodyChoice::Measured { measurements, .. } | BodyChoice::Shaped { measurements, .. } => {
                Some(&**measurements)
            }
            BodyChoice::Sample(_) => self.named_size(),
            BodyChoice::OfPattern => self
                .named_size()
                .or_else(|| self.pattern.base_measurements()),
        };
        let figure = self.figure();
        size.map_or_else(|| sample_of(figure), |size| size.completed(figure.build()))
    }

    /// The measurements that a pattern worn with the project's is drafted to [m], [rad]: its own table's
    /// for the named size, else those of the wearer.
    pub(crate) fn drafted_for(&self, pattern: &Pattern) -> Measurements {
        let named = self.size.as_deref().and_then(|name| pattern.size(name));
        named.cloned().unwrap_or_else(|| self.wearer())
    }

    /// The measurements the pattern is drafted to [m], [rad]: the named size; else those of the
    /// body that was chosen; else the pattern's base size.
    pub fn drafted_to(&self) -> Measurements {
        match self.named_size() {
            Some(size) => size.clone(),
            None => self.wearer(),
        }
    }
}
