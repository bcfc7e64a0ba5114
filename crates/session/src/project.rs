//! The project: all that is edited, saved and undone; the rest is derived from it.
//!
//! # Decided with
//! - [`crate::choice::BodyChoice`], [`crate::choice::Quality`]: wearer and quality;
//! - [`crate::session::Session::perform`] (`perform.rs`): the commands that change it; `begin` keeps the
//!   quality for another pattern;
//! - [`crate::fitting`] (`fitting_of`), [`toile_interchange::Fitting`]: how it is read from the file of the
//!   pattern, and written to it;
//! - [`crate::mannequin_source::MannequinSource`], [`crate::placed_panels::PanelOrigin`],
//!   [`crate::open::open_pattern_from`]: the body it needs; where panels of a file stand;
//! - [`crate::project::Project::drafted_to`], [`toile_pattern::Wearer`]: whom it is drafted for;
//! - [`crate::project::Project::refuse_faults`], [`crate::outfit::checked`], [`crate::tools::sound_draft`]:
//!   faults that keep a garment, a mesh or a file from being made; prints and reports only tell them;
//! - [`crate::derived::Derived::garment_edit`] (`garment_edit.rs`): what becomes of a worn garment when it
//!   changes.
//!
//! By hand: a new choice in `says_the_same` (unsaved or not), in `Derived::follow` and in the window
//! (`tables/wearer.rs`, `tables/worn_with.rs`, `app/garment_pane.rs`).

use crate::choice::sample_of;
use crate::{BodyChoice, FabricChoice, Quality, SessionError, Shown};
use std::path::PathBuf;
use std::sync::Arc;
use toile_body::Figure;
use toile_measure::{Measurements, Origin};
use toile_pattern::{Diagnostic, Edit, EditError, GarmentCloth, Pattern, Severity, Wearer};

/// Everything a person decides. Cloning is cheap.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Project {
    /// The pattern.
    pub pattern: Arc<Pattern>,
    /// The file that the pattern was read from or last saved to.
    pub source: Option<PathBuf>,
    /// Body that the garment is draped on.
    pub body: BodyChoice,
    /// Name of a size of the pattern; `None` means the base size, or the measured body.
    pub size: Option<String>,
    /// A fabric that replaces the fabric of every panel.
    pub fabric: Option<FabricChoice>,
    /// Width of the fabric (m); `None` means the fabric's own width.
    pub width: Option<f64>,
    /// Quality of mesh and drape.
    pub quality: Quality,
    /// Layer of the garment among `others`: larger numbers lie farther out.
    pub layer: u16,
    /// Garments worn with the project's own.
    pub others: Vec<WornGarment>,
}

/// A garment worn with the project's own garment, made in the same size, fabric and quality.
#[derive(Clone, Debug, PartialEq)]
pub struct WornGarment {
    /// Pattern of the garment; `None` if it could not be read when the pattern that names it was opened.
    pub pattern: Option<Arc<Pattern>>,
    /// The file that the garment's pattern was read from.
    pub source: PathBuf,
    /// Layer of the garment.
    pub layer: u16,
}

impl WornGarment {
    /// Name of the garment's pattern, or of the file that could not be read.
    pub fn name(&self) -> String {
        match &self.pattern {
            Some(pattern) => pattern.name.clone(),
            None => self.source.display().to_string(),
        }
    }
}

impl Project {
    /// Whether the files of the two projects would have the same content.
    pub fn says_the_same(&self, other: &Self) -> bool {
        let same_pattern = Arc::ptr_eq(&self.pattern, &other.pattern)
            || self.pattern.says_the_same(&other.pattern);
        let worn = |project: &Self| {
            let others = project.others.iter();
            let each = others.map(|worn| (worn.source.clone(), worn.layer));
            each.collect::<Vec<_>>()
        };
        same_pattern
            && self.body == other.body
            && self.size == other.size
            && self.fabric == other.fabric
            && self.width == other.width
            && self.layer == other.layer
            && worn(self) == worn(other)
    }

    /// The project with all `edits` made in its pattern; if one is refused, none is made.
    pub(crate) fn edited(&self, edits: &[Edit]) -> Result<Self, EditError> {
        let mut pattern = (*self.pattern).clone();
        pattern.apply(edits)?;
        let mut next = Self {
            pattern: Arc::new(pattern),
            ..self.clone()
        };
        // When a size or fabric is renamed, the choice of it follows; when it is removed, the choice is given
        // up.
        let (before, after) = (&self.pattern, &next.pattern);
        next.size = self.size.as_ref().and_then(|name| {
            let id = before.size_named(name)?.id;
            let size = after.sizes.iter().find(|size| size.id == id)?;
            Some(size.name.clone())
        });
        next.fabric = match &self.fabric {
            Some(FabricChoice::Named(name)) => {
                let own = before.fabrics.iter().find(|fabric| fabric.name == *name);
                let renamed = own.and_then(|fabric| after.fabric(fabric.id));
                let name = renamed.map_or(name, |fabric| &fabric.name).clone();
                let was_there = self
                    .fabric
                    .as_ref()
                    .and_then(|f| f.fabric(before))
                    .is_some();
                let choice = FabricChoice::Named(name);
                let is_gone = was_there && choice.fabric(after).is_none();
                (!is_gone).then_some(choice)
            }
            other => other.clone(),
        };
        Ok(next)
    }

    /// Fabric and width that the whole garment is cut from. A chosen fabric that is missing is ignored.
    pub fn garment_cloth(&self) -> GarmentCloth {
        let fabric = self.fabric.as_ref().and_then(|f| f.fabric(&self.pattern));
        GarmentCloth {
            fabric: fabric.map(Arc::new),
            width: self.width,
        }
    }

    /// The figure the mannequin is grown from.
    pub fn figure(&self) -> Figure {
        match &self.body {
            BodyChoice::OfPattern | BodyChoice::Missing { .. } => {
                match self.pattern.sizes.is_empty() {
                    true => Figure::Mean,
                    false => Figure::Woman,
                }
            }
            BodyChoice::Sample(figure) | BodyChoice::Measured { figure, .. } => *figure,
            BodyChoice::Shaped { description, .. } => description.figure,
        }
    }

    /// Name of the size that the pattern is drafted to, if it is one of the pattern's own sizes.
    pub fn size_name(&self) -> Option<&str> {
        match (&self.size, &self.body) {
            (Some(size), _) => Some(size),
            (None, body) if body.is_of_pattern() => self.pattern.base().map(|size| &*size.name),
            (None, _) => None,
        }
    }

    /// Size or body that the pattern is drafted to, in words.
    pub fn drafted_to_words(&self) -> String {
        match self.size_name() {
            Some(size) => format!("size {size}"),
            None if self.body.is_of_pattern() => "as drawn".into(),
            None => "drafted to the body".into(),
        }
    }

    /// Name of the wearer that the garment is made to measure for, and the girths of bust, waist and hips;
    /// `None` if the garment is drafted to a size of the pattern, as drawn, or to a figure that nobody was
    /// measured for.
    pub fn made_for(&self) -> Option<[String; 2]> {
        let is_measured = matches!(
            self.body,
            BodyChoice::Measured { .. } | BodyChoice::Shaped { .. }
        );
        if self.size_name().is_some() || !is_measured {
            return None;
        }
        let measurements = self.drafted_to().measurements;
        let shown = Shown(self.pattern.unit);
        let girths = ["bust", "waist", "hips"].into_iter().filter_map(|name| {
            let girth = measurements.get(name)?;
            Some(format!("{name} {}", shown.length(girth)))
        });
        Some([
            self.body.short_name(),
            girths.collect::<Vec<_>>().join(", "),
        ])
    }

    /// Size or wearer that the pieces are drafted to, in words to write on a piece.
    pub fn whose(&self) -> String {
        match self.size_name() {
            Some(size) => size.to_owned(),
            None => {
                let is_figure = matches!(self.body, BodyChoice::Sample(_));
                let prefix = if is_figure { "the figure " } else { "" };
                format!("made for {prefix}{}", self.body.short_name())
            }
        }
    }

    /// Size of the garment, or the wearer that it is made for (with girths, if measured), in words for a
    /// title; `None` if the pattern has no sizes and nobody was measured.
    pub(crate) fn made_words(&self) -> Option<String> {
        if let Some(size) = self.size_name() {
            return Some(format!("size {size}"));
        }
        if let Some([wearer, girths]) = self.made_for() {
            return Some(format!("made to measure for {wearer} ({girths})"));
        }
        (!self.pattern.sizes.is_empty()).then(|| self.whose())
    }

    /// A name with [`Project::made_words`], for a title.
    pub(crate) fn titled(&self, name: &str) -> String {
        match self.made_words() {
            Some(words) => format!("{name}, {words}"),
            None => name.to_owned(),
        }
    }

    /// Refuses a size that the pattern does not have, or that a pattern worn with it lacks in its table of
    /// sizes.
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
        for worn in &self.others {
            let Some(pattern) = &worn.pattern else {
                continue;
            };
            if !pattern.sizes.is_empty() && pattern.size(name).is_none() {
                return refuse(pattern, &format!(", those of {}", worn.source.display()));
            }
        }
        Ok(())
    }

    /// The patterns of the garments that are worn with the project's and could be read.
    pub(crate) fn other_patterns(&self) -> impl Iterator<Item = (&WornGarment, &Arc<Pattern>)> {
        let others = self.others.iter();
        others.filter_map(|worn| Some((worn, worn.pattern.as_ref()?)))
    }

    /// Refuses a pattern with faults that keep the garment from being made in the project's size.
    pub(crate) fn refuse_faults(&self, found: &[Diagnostic]) -> Result<(), SessionError> {
        self.refuse_faults_in(self.size_name(), found)
    }

    /// Refuses a pattern with faults that keep the garment from being made in a size.
    pub(crate) fn refuse_faults_in(
        &self,
        size: Option<&str>,
        found: &[Diagnostic],
    ) -> Result<(), SessionError> {
        let errors = found.iter().filter(|d| d.severity == Severity::Error);
        let size = size
            .filter(|_| self.pattern.sizes.len() > 1)
            .map_or_else(String::new, |size| format!("size {size}: "));
        let faults: Vec<String> = errors.map(|fault| format!("{size}{fault}")).collect();
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

    /// The measurements that the mannequin was given (m), (rad): those of the file or the typed ones;
    /// else those of the named size, or of the pattern's base size where no body was chosen.
    fn given_measurements(&self) -> Option<&Measurements> {
        match &self.body {
            BodyChoice::Measured { measurements, .. } | BodyChoice::Shaped { measurements, .. } => {
                Some(&**measurements)
            }
            BodyChoice::Sample(_) => self.named_size(),
            BodyChoice::OfPattern | BodyChoice::Missing { .. } => self
                .named_size()
                .or_else(|| self.pattern.base_measurements()),
        }
    }

    /// Measurements that were asked of the mannequin (m), (rad); all others are predicted from these.
    pub fn asked_measurements(&self) -> Measurements {
        let mut asked = Measurements::new();
        let given = self.given_measurements().into_iter();
        for (name, measured) in given.flat_map(Measurements::iter) {
            if measured.origin == Origin::Asked {
                // A name and value of one table are always valid in another.
                let _ = asked.set(name, measured.value, Origin::Asked);
            }
        }
        asked
    }

    /// The measurements of the mannequin (m), (rad): those that it was given, else the figure's
    /// averages. Missing ones are predicted from them.
    pub fn body_measurements(&self) -> Measurements {
        let figure = self.figure();
        self.given_measurements().map_or_else(
            || sample_of(figure),
            |given| given.completed(figure.build()),
        )
    }

    /// Wearer that `pattern`, which is worn with the project's own garment, is drafted for: the named size of
    /// its own table, else the wearer of the project.
    pub(crate) fn drafted_for(&self, pattern: &Pattern) -> Wearer {
        let named = self
            .size
            .as_deref()
            .and_then(|name| pattern.size_named(name));
        named.map_or_else(|| (&self.body_measurements()).into(), Wearer::from)
    }

    /// Wearer that the pattern is drafted for: the named size; else the body that was chosen; else
    /// the pattern's base size, with missing measurements predicted.
    pub fn drafted_to(&self) -> Wearer {
        let pattern = &self.pattern;
        let named = self
            .size
            .as_deref()
            .and_then(|name| pattern.size_named(name));
        named.map_or_else(
            || Wearer {
                measurements: self.body_measurements(),
                size: match self.body.is_of_pattern() {
                    true => pattern.base().map(|size| size.id),
                    false => None,
                },
            },
            Wearer::from,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_pattern::{Evaluation, Number, Size, Variable};

    /// Values that sizes have of their own are taken in the size that is drafted, and in the base
    /// size where the body is the pattern's own.
    #[test]
    fn a_size_has_its_own_values() {
        let mut pattern = Pattern::new("skirt");
        for (name, waist) in [("S", 0.7), ("M", 0.75)] {
            let mut measurements = Measurements::new();
            measurements.set("waist", waist, Origin::Asked).unwrap();
            let (id, name) = (pattern.ids.take(), name.into());
            pattern.sizes.push(Arc::new(Size {
                id,
                name,
                measurements,
            }));
        }
        let [small, medium] = [0, 1].map(|k: usize| pattern.sizes[k].id);
        pattern.base_size = Some(medium);
        let id = pattern.ids.take();
        let number = Number::PerSize {
            usual: Box::new(1.0.into()),
            sizes: vec![(small, 2.0), (medium, 3.0)],
        };
        let name = "pleats".into();
        pattern
            .variables
            .push(Arc::new(Variable { id, name, number }));
        let mut project = Project {
            pattern: Arc::new(pattern),
            ..Project::default()
        };
        let pleats = |project: &Project| {
            let evaluation = Evaluation::new(&project.pattern, project.drafted_to());
            evaluation.variable(id).map(|(value, _)| value)
        };
        assert_eq!(pleats(&project), Some(3.0));
        project.size = Some("S".into());
        assert_eq!(pleats(&project), Some(2.0));
        project.size = None;
        project.body = BodyChoice::Sample(Figure::Woman);
        assert_eq!(pleats(&project), Some(1.0));
    }
}
