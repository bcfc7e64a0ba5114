//! Figures of a material: found by name, compared, checked, given other numbers.

use crate::domain::{Domain, Unit};
use crate::material::{Access, FIGURES, Figure, Material};

/// A number of a material outside its domain.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{field} is {value}; {remedy}")]
pub struct FigureFault {
    /// Name of the number, with its unit.
    pub field: String,
    /// Value of the number (SI).
    pub value: f64,
    /// The remedy.
    pub remedy: &'static str,
}

impl Figure {
    /// The figure of a name in scenes and fabric files.
    pub fn named(name: &str) -> Option<&'static Self> {
        FIGURES.iter().find(|figure| figure.name == name)
    }

    /// Numbers of the figure in a material: one for each component, none where an optional one is absent.
    pub fn numbers(&self, material: &Material) -> Vec<f64> {
        match self.access {
            Access::Numbers { get, .. } => get(material).to_vec(),
            Access::Optional { get, .. } => get(material).iter().copied().collect(),
            Access::Compression { .. } => Vec::new(),
        }
    }

    /// Whether two materials have the same.
    pub fn is_same(&self, a: &Material, b: &Material) -> bool {
        match self.access {
            Access::Numbers { get, .. } => get(a) == get(b),
            Access::Optional { get, .. } => get(a) == get(b),
            Access::Compression { get, .. } => get(a) == get(b),
        }
    }

    /// Whether a material has it at its default.
    pub fn is_default(&self, material: &Material) -> bool {
        self.is_same(material, &Material::default())
    }

    /// Whether one of its numbers may be absent.
    pub fn may_be_absent(&self) -> bool {
        self.domain == Domain::Limit || matches!(self.access, Access::Optional { .. })
    }

    /// The first of its numbers in a material that lies outside its domain: component and value.
    pub(crate) fn fault(&self, material: &Material) -> Option<FigureFault> {
        let numbers = self.numbers(material);
        let wrong = |value: &f64| !self.domain.contains(*value);
        let k = numbers.iter().position(wrong)?;
        let unit = match self.unit.si {
            "" => String::new(),
            si => format!(" [{si}]"),
        };
        let component = match self.components.get(k) {
            None => String::new(),
            // A share that is kept is one of stretch or of folds.
            Some(&"stretch") => " of stretch".to_owned(),
            Some(&"fold") => " of folds".to_owned(),
            Some(direction) => format!(" along {direction}"),
        };
        Some(FigureFault {
            field: format!("{}{component}{unit}", self.term),
            value: numbers[k],
            remedy: self.domain.remedy(),
        })
    }
}

/// One number of a figure: the figure itself, or its value along warp, weft or bias.
#[derive(Clone, Copy, Debug)]
pub struct Component {
    /// The figure.
    pub figure: &'static Figure,
    /// Index of the component.
    pub index: usize,
}

impl PartialEq for Component {
    fn eq(&self, other: &Self) -> bool {
        (self.figure.name, self.index) == (other.figure.name, other.index)
    }
}

impl Component {
    /// Every number of every figure, in the order of the table.
    pub fn all() -> impl Iterator<Item = Self> {
        FIGURES.iter().flat_map(|figure| {
            let count = match figure.access {
                Access::Numbers { .. } => figure.components.len().max(1),
                Access::Optional { .. } => 1,
                Access::Compression { .. } => 0,
            };
            (0..count).map(move |index| Self { figure, index })
        })
    }

    /// The label in the window, as `Stretch, warp`.
    pub fn label(self) -> String {
        match self.figure.components.get(self.index) {
            None => self.figure.label.to_owned(),
            Some(component) => format!("{}, {component}", self.figure.label),
        }
    }

    /// The name in checks of patterns, as `warp stretch stiffness`.
    pub fn noun(self) -> String {
        match self.figure.components.get(self.index) {
            None => self.figure.noun.to_owned(),
            Some(component) => format!("{component} {}", self.figure.noun),
        }
    }

    /// The value in a material (SI); nothing for an absent number or an infinite limit.
    pub fn of(self, material: &Material) -> Option<f64> {
        let value = self.figure.numbers(material).get(self.index).copied();
        value.filter(|value| self.figure.domain != Domain::Limit || value.is_finite())
    }

    /// Gives a material another value (SI). Without one an optional number is absent and a limit infinite;
    /// other numbers stay.
    pub fn set(self, material: &mut Material, value: Option<f64>) {
        match self.figure.access {
            Access::Numbers { get_mut, .. } => {
                let absent = (self.figure.domain == Domain::Limit).then_some(f64::INFINITY);
                if let Some(value) = value.or(absent) {
                    get_mut(material)[self.index] = value;
                }
            }
            Access::Optional { get_mut, .. } => *get_mut(material) = value,
            Access::Compression { .. } => {}
        }
    }

    /// Whether a value (SI) is one that a cloth may be given in the window.
    ///
    /// # Errors
    /// It is not: the range, in the unit shown.
    pub fn check(self, value: Option<f64>) -> Result<(), String> {
        let [min, max] = self.figure.range;
        let is_good = match value {
            Some(value) => (min..=max).contains(&value),
            None => self.figure.may_be_absent(),
        };
        if is_good {
            return Ok(());
        }
        let Unit { shown, factor, .. } = self.figure.unit;
        // Round figures in their unit are told as such.
        let [min, max] = [min, max].map(|end| (end / factor * 1e6).round() / 1e6);
        let told = format!("give {min} to {max} {shown}");
        Err(match self.figure.may_be_absent() {
            true => format!("{}, or none", told.trim_end()),
            false => told.trim_end().to_owned(),
        })
    }
}

impl Material {
    /// Whether every number lies in its domain.
    ///
    /// # Errors
    /// The first number outside, with the remedy.
    pub fn in_domain(&self) -> Result<(), FigureFault> {
        match FIGURES.iter().find_map(|figure| figure.fault(self)) {
            None => Ok(()),
            Some(fault) => Err(fault),
        }
    }
}
