//! The material of a cloth: the table of its figures, in SI units.
//!
//! # Decided with
//! - [`crate::domain::Domain`], [`crate::material::Material::in_domain`] (`figure.rs`),
//!   [`crate::figure::Component::check`]: values that are refused, ranges in the window;
//! - [`crate::figure_value::FigureValue`]: figures as JSON has them;
//! - [`crate::library::LIBRARY`], [`crate::kes::KesValues`]: fabrics and textile tests that give them.
//!
//! Checked and written by crates `pattern` (`check.rs`, `check_fabric`; `fabric/visit.rs`, `fabric/record.rs`) and
//! `interchange` (`scene_material.rs`); acted on by crate `drape` (`material.rs`; friction: `rest_data.rs`, `lump`,
//! `contact_refinement.rs`, `refine`, `collision/detector.rs`, `contact`); shown by the window, `tables/fabric_figures.rs`.

use crate::domain::{Domain, Unit};
use crate::sources::FabricSources;
use serde::{Deserialize, Serialize};

/// Behaviour of a membrane under compression.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    Serialize,
    Deserialize,
    strum::VariantArray,
    strum::VariantNames,
)]
#[strum(serialize_all = "kebab-case")]
pub enum Compression {
    /// The law of tension. The Hessian may omit its negative part.
    #[default]
    Full,
    /// Tension field: the membrane wrinkles below the resolution of the mesh and has no compressive stress.
    TensionField,
}

/// Access to a figure of a material.
#[derive(Clone, Copy, Debug)]
pub enum Access {
    /// One number for each component.
    Numbers {
        /// The numbers.
        get: fn(&Material) -> &[f64],
        /// The same, to be changed.
        get_mut: fn(&mut Material) -> &mut [f64],
    },
    /// A number that may be absent.
    Optional {
        /// The number.
        get: fn(&Material) -> &Option<f64>,
        /// The same, to be changed.
        get_mut: fn(&mut Material) -> &mut Option<f64>,
    },
    /// A kind of compression.
    Compression {
        /// The kind.
        get: fn(&Material) -> &Compression,
        /// The same, to be changed.
        get_mut: fn(&mut Material) -> &mut Compression,
    },
}

/// A figure of cloth. Nothing has a default: an entry of the table that leaves something out, here the domain, does
/// not compile.
///
/// ```compile_fail,E0063
/// use toile_fabric::{Access, Figure, Unit};
/// static WEIGHT: Figure = Figure {
///     name: "weight",
///     pattern_key: "weight",
///     is_always_written: true,
///     term: "weight",
///     noun: "weight",
///     label: "Weight",
///     about: "Mass of a square metre",
///     components: &[],
///     unit: Unit::si("kg/m2"),
///     positive_in_patterns: true,
///     pattern_remedy: None,
///     range: [1e-3, 10.0],
///     source: None,
///     access: Access::Numbers {
///         get: |material| std::slice::from_ref(&material.density),
///         get_mut: |material| std::slice::from_mut(&mut material.density),
///     },
/// };
/// ```
#[derive(Debug)]
pub struct Figure {
    /// Name in scenes, fabric files and journals.
    pub name: &'static str,
    /// Key in pattern files.
    pub pattern_key: &'static str,
    /// Whether pattern files always have it; others are left out at the default.
    pub is_always_written: bool,
    /// Name in refusals of scenes.
    pub term: &'static str,
    /// Name in checks of patterns.
    pub noun: &'static str,
    /// Label in the window.
    pub label: &'static str,
    /// Explanation for somebody who sews.
    pub about: &'static str,
    /// Components, by their keys in pattern files: none for a single number.
    pub components: &'static [&'static str],
    /// Unit of its numbers.
    pub unit: Unit,
    /// Numbers that the laws of cloth take.
    pub domain: Domain,
    /// Whether a pattern's cloth must have it above zero, where the laws would take zero too.
    pub positive_in_patterns: bool,
    /// Remedy in checks of patterns, where another than that of the domain.
    pub pattern_remedy: Option<&'static str>,
    /// The smallest and the largest that the window takes (SI): well beyond apparel, from chiffon (30 g/m2, 1 uN m) to
    /// sole leather.
    pub range: [f64; 2],
    /// The source given for it by the library; nothing where a figure is usual for its kind.
    pub source: Option<fn(&FabricSources) -> &'static str>,
    /// Access to it in a material.
    pub access: Access,
}

/// Single numbers and arrays of them as slices.
trait Numbers {
    fn numbers(&self) -> &[f64];
    fn numbers_mut(&mut self) -> &mut [f64];
}

impl Numbers for f64 {
    fn numbers(&self) -> &[f64] {
        std::slice::from_ref(self)
    }

    fn numbers_mut(&mut self) -> &mut [f64] {
        std::slice::from_mut(self)
    }
}

impl<const N: usize> Numbers for [f64; N] {
    fn numbers(&self) -> &[f64] {
        self
    }

    fn numbers_mut(&mut self) -> &mut [f64] {
        self
    }
}

/// Access to a field of [`Material`].
macro_rules! access {
    (numbers $field:ident) => {
        Access::Numbers {
            get: |material| Numbers::numbers(&material.$field),
            get_mut: |material| Numbers::numbers_mut(&mut material.$field),
        }
    };
    (optional $field:ident) => {
        Access::Optional {
            get: |material| &material.$field,
            get_mut: |material| &mut material.$field,
        }
    };
    (compression $field:ident) => {
        Access::Compression {
            get: |material| &material.$field,
            get_mut: |material| &mut material.$field,
        }
    };
}

/// Declares [`Material`] and [`FIGURES`] together: a figure is a field with its default, and all that is said of it.
macro_rules! figures {
    ($(
        $(#[$about:meta])*
        $field:ident: $type:ty = $default:expr, $access:ident, $entry:ident { $($said:tt)* }
    )*) => {
        /// An orthotropic cloth: membrane, bending, mass, surface, and how it loses energy.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub struct Material {
            $($(#[$about])* pub $field: $type,)*
        }

        impl Default for Material {
            /// A plain cotton weave. Round figures inside the ranges of measured fabrics: mass and bending
            /// near the medians 0.197 kg/m2 and 13.8 uN m of 618 fabrics (Feng et al. 2022); the stretch
            /// stiffness is that of a soft weave, so that a drape has strains of a few per cent. Elastic,
            /// without limit, hardening or relaxation.
            fn default() -> Self {
                Self { $($field: $default,)* }
            }
        }

        /// Every figure, in the order of the fields of [`Material`].
        pub static FIGURES: [Figure; [$(stringify!($field)),*].len()] =
            [$($entry { $($said)*, access: access!($access $field) }),*];
    };
}

const WARP_WEFT: &[&str] = &["warp", "weft"];
const WARP_WEFT_BIAS: &[&str] = &["warp", "weft", "bias"];
const STRETCH_FOLD: &[&str] = &["stretch", "fold"];

figures! {
    /// Mass per area (kg/m2).
    density: f64 = 0.2, numbers, Figure {
        name: "density",
        pattern_key: "density_kg_per_m2",
        is_always_written: true,
        term: "density",
        noun: "density",
        label: "Weight",
        about: "What a square metre weighs",
        components: &[],
        unit: Unit::shown_as("kg/m2", "g/m\u{b2}", 1e-3),
        domain: Domain::Positive,
        positive_in_patterns: true,
        pattern_remedy: None,
        range: [1e-3, 10.0],
        source: Some(|sources| sources.density)
    }

    /// Thickness (m): contact offsets are at least half of it from solids and all of it between two cloths.
    thickness: f64 = 0.5e-3, numbers, Figure {
        name: "thickness",
        pattern_key: "thickness_m",
        is_always_written: true,
        term: "thickness",
        noun: "thickness",
        label: "Thickness",
        about: "Of one layer laid flat",
        components: &[],
        unit: Unit::shown_as("m", "mm", 1e-3),
        domain: Domain::NotNegative,
        positive_in_patterns: true,
        pattern_remedy: None,
        range: [1e-5, 0.02],
        source: Some(|sources| sources.thickness)
    }

    /// Stretch stiffness along warp and weft (N/m).
    stretch: [f64; 2] = [600.0, 600.0], numbers, Figure {
        name: "stretch",
        pattern_key: "stretch_N_per_m",
        is_always_written: true,
        term: "stretch",
        noun: "stretch stiffness",
        label: "Stretch",
        about: "Force on a metre of width that would stretch it to twice its length, along the grain (warp) or across it",
        components: WARP_WEFT,
        unit: Unit::si("N/m"),
        domain: Domain::Positive,
        positive_in_patterns: true,
        pattern_remedy: None,
        range: [1.0, 1e6],
        source: Some(|sources| sources.stretch)
    }

    /// Shear stiffness (N/m): force per length at a shear angle of one radian.
    shear: f64 = 60.0, numbers, Figure {
        name: "shear",
        pattern_key: "shear_N_per_m",
        is_always_written: true,
        term: "shear",
        noun: "shear stiffness",
        label: "Shear",
        about: "How hard it is to skew, as on the bias: force on a metre of width for each radian",
        components: &[],
        unit: Unit::si("N/m"),
        domain: Domain::Positive,
        positive_in_patterns: true,
        pattern_remedy: None,
        range: [0.1, 1e6],
        source: Some(|sources| sources.shear)
    }

    /// Poisson ratio of warp to weft, at most 0.95 of the limit of a stable membrane.
    poisson: f64 = 0.2, numbers, Figure {
        name: "poisson",
        pattern_key: "poisson",
        is_always_written: true,
        term: "Poisson ratio",
        noun: "Poisson ratio",
        label: "Narrowing",
        about: "How much it narrows where it is stretched (Poisson's ratio)",
        components: &[],
        unit: Unit::NONE,
        domain: Domain::Ratio,
        positive_in_patterns: false,
        pattern_remedy: Some("give a number from 0 to 0.95, usually 0.2 to 0.3"),
        range: [0.0, 0.95],
        source: None
    }

    /// Hardening k along warp and weft: stress C (E + k E^3) in tension. 0 is a linear law; a
    /// weave whose stiffness doubles at 5 % of stretch has 130.
    hardening: [f64; 2] = [0.0; 2], numbers, Figure {
        name: "hardening",
        pattern_key: "hardening",
        is_always_written: false,
        term: "hardening",
        noun: "hardening",
        label: "Hardening",
        about: "How much stiffer it gets as it is stretched: at a strain E the force is E + k E\u{b3} times the stiffness",
        components: WARP_WEFT,
        unit: Unit::NONE,
        domain: Domain::NotNegative,
        positive_in_patterns: false,
        pattern_remedy: None,
        range: [0.0, 1e6],
        source: Some(|sources| sources.stretch)
    }

    /// Stretch beyond which warp and weft are 100 times as stiff, as a share of the rest length; infinite for none.
    /// Usual:
    /// 0.01 to 0.1.
    #[serde(with = "crate::exact::pair")]
    strain_limit: [f64; 2] = [f64::INFINITY; 2], numbers, Figure {
        name: "strain_limit",
        pattern_key: "strain_limit",
        is_always_written: false,
        term: "strain limit",
        noun: "strain limit",
        label: "Stretch limit",
        about: "Stretch that it hardly exceeds, as a share of its length: 0.05 is 5 %; empty for none",
        components: WARP_WEFT,
        unit: Unit::NONE,
        domain: Domain::Limit,
        positive_in_patterns: false,
        pattern_remedy: None,
        range: [1e-3, 10.0],
        source: None
    }

    /// Law of the membrane under compression.
    compression: Compression = Compression::Full, compression, Figure {
        name: "compression",
        pattern_key: "compression",
        is_always_written: false,
        term: "compression",
        noun: "compression",
        label: "Compression",
        about: "Pushed together it resists (full), or wrinkles finer than the mesh and does not (tension-field)",
        components: &[],
        unit: Unit::NONE,
        domain: Domain::NotNegative,
        positive_in_patterns: false,
        pattern_remedy: None,
        range: [0.0, 0.0],
        source: None
    }

    /// Bending stiffness of strips cut along warp, weft and bias (N m).
    bend: [f64; 3] = [1.5e-5, 1.5e-5, 1.2e-5], numbers, Figure {
        name: "bend",
        pattern_key: "bend_N_m",
        is_always_written: true,
        term: "bend",
        noun: "bending stiffness",
        label: "Bend",
        about: "How stiff a fold is, of a strip cut along the grain (warp), across it or on the bias: 5 drapes softly, 100 stands",
        components: WARP_WEFT_BIAS,
        unit: Unit::shown_as("N m", "\u{b5}N m", 1e-6),
        domain: Domain::NotNegative,
        positive_in_patterns: true,
        pattern_remedy: None,
        range: [1e-8, 0.1],
        source: Some(|sources| sources.bend)
    }

    /// Poisson ratio in bending: curvature of the weft opposed to that of the warp. Rarely measured; 0 for
    /// cloth.
    bend_poisson: f64 = 0.0, numbers, Figure {
        name: "bend_poisson",
        pattern_key: "bend_poisson",
        is_always_written: false,
        term: "Poisson ratio in bending",
        noun: "Poisson ratio in bending",
        label: "Curling across",
        about: "How much a strip curls across where it is bent (Poisson's ratio in bending); 0 for cloth",
        components: &[],
        unit: Unit::NONE,
        domain: Domain::Ratio,
        positive_in_patterns: false,
        pattern_remedy: None,
        range: [0.0, 0.95],
        source: None
    }

    /// Viscosity of stretch and shear (Kelvin-Voigt) (N s/m).
    viscosity: f64 = 0.0, numbers, Figure {
        name: "viscosity",
        pattern_key: "viscosity_N_s_per_m",
        is_always_written: false,
        term: "viscosity",
        noun: "viscosity",
        label: "Viscosity",
        about: "How it damps stretching and skewing; acts in motion only",
        components: &[],
        unit: Unit::si("N s/m"),
        domain: Domain::NotNegative,
        positive_in_patterns: false,
        pattern_remedy: None,
        range: [0.0, 1e3],
        source: None
    }

    /// Viscosity of bending (Kelvin-Voigt) (N m s).
    bend_viscosity: f64 = 0.0, numbers, Figure {
        name: "bend_viscosity",
        pattern_key: "bend_viscosity_N_m_s",
        is_always_written: false,
        term: "bending viscosity",
        noun: "bending viscosity",
        label: "Bend viscosity",
        about: "How it damps folding; acts in motion only",
        components: &[],
        unit: Unit::shown_as("N m s", "\u{b5}N m s", 1e-6),
        domain: Domain::NotNegative,
        positive_in_patterns: false,
        pattern_remedy: None,
        range: [0.0, 0.1],
        source: None
    }

    /// Rayleigh damping: viscosity in proportion to stiffness (s).
    stiffness_damping: f64 = 0.0, numbers, Figure {
        name: "stiffness_damping",
        pattern_key: "stiffness_damping_s",
        is_always_written: false,
        term: "stiffness damping",
        noun: "stiffness damping",
        label: "Damping",
        about: "Viscosity in proportion to every stiffness (Rayleigh); acts in motion only",
        components: &[],
        unit: Unit::shown_as("s", "ms", 1e-3),
        domain: Domain::NotNegative,
        positive_in_patterns: false,
        pattern_remedy: None,
        range: [0.0, 1.0],
        source: None
    }

    /// Relaxed fraction p of the stress of stretch and of bending, 0 to 0.95: under constant strain the stress falls to
    /// 1 - p of its first value, and released the cloth retains p of the strain at first.
    relaxed_fraction: [f64; 2] = [0.0; 2], numbers, Figure {
        name: "kept",
        pattern_key: "kept",
        is_always_written: false,
        term: "kept share",
        noun: "kept share",
        label: "Kept",
        about: "Share of a stretch or a fold that stays when it was held for long; acts in motion only",
        components: STRETCH_FOLD,
        unit: Unit::NONE,
        domain: Domain::Ratio,
        positive_in_patterns: false,
        pattern_remedy: None,
        range: [0.0, 0.95],
        source: None
    }

    /// Time tau over which the internal strain follows the strain (s).
    relaxation_time: f64 = 10.0, numbers, Figure {
        name: "relaxation_time",
        pattern_key: "relaxation_time_s",
        is_always_written: false,
        term: "relaxation time",
        noun: "relaxation time",
        label: "Relaxation",
        about: "Time in which the kept share settles",
        components: &[],
        unit: Unit::si("s"),
        domain: Domain::Positive,
        positive_in_patterns: true,
        pattern_remedy: None,
        range: [1e-3, 1e6],
        source: None
    }

    /// Coulomb friction coefficient against solids; between two cloths the mean of both is used.
    friction: f64 = 0.4, numbers, Figure {
        name: "friction",
        pattern_key: "friction",
        is_always_written: true,
        term: "friction",
        noun: "friction",
        label: "Friction",
        about: "Against skin: 0 slides, 0.5 clings",
        components: &[],
        unit: Unit::NONE,
        domain: Domain::NotNegative,
        positive_in_patterns: false,
        pattern_remedy: Some("give zero or more, usually 0.3 to 0.5"),
        range: [0.0, 5.0],
        source: Some(|sources| sources.friction)
    }

    /// Coefficient of restitution, 0 to 1; none where the contact spring alone decides. Only `xpbd` supports it.
    restitution: Option<f64> = None, optional, Figure {
        name: "restitution",
        pattern_key: "restitution",
        is_always_written: false,
        term: "restitution",
        noun: "restitution",
        label: "Rebound",
        about: "Share of its speed with which it leaves what it hits; empty for none. A garment at rest is draped without it",
        components: &[],
        unit: Unit::NONE,
        domain: Domain::Share,
        positive_in_patterns: false,
        pattern_remedy: None,
        range: [0.0, 1.0],
        source: None
    }
}

impl Material {
    /// Whether the stress depends on time: on speeds, or on earlier strain.
    pub fn acts_in_time(&self) -> bool {
        self.viscosity > 0.0
            || self.bend_viscosity > 0.0
            || self.stiffness_damping > 0.0
            || self.relaxed_fraction != [0.0; 2]
    }
}
