//! Features of a world beyond elastic cloth under gravity, and the methods that support each. A world with a feature
//! that its method does not support is refused.
//!
//! # Decided with
//! - [`crate::method::MethodKind`]: the methods;
//! - [`crate::scene_run::SceneRun::apply_edit`]: checks features again after an edit;
//! - crate `reference` (`patches/`: `is_plain`): laws that patches leave to velocity Verlet;
//! - [`crate::methods`] (`guard.rs`, `Guarded`): refuses attachments to moving solids where a method does not
//!   follow them.
//!
//! The compiler asks a new feature who asks for it and who supports it. By hand: `only_damps`, `is_plain`, a
//! case in `reference/tests/suite/features.rs`, a row in `docs/methods/integrators.md`.

use crate::material::DissipativeLaws;
use crate::world::{Kind, Object, World};
use crate::{Compression, DrapeError, Material, MethodKind};
use strum::{EnumCount, VariantArray, VariantNames};

/// An optional feature of a world.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, EnumCount, VariantArray, VariantNames,
)]
pub enum Feature {
    /// Solids on a prescribed motion.
    #[strum(serialize = "moving objects")]
    MovingObjects,
    /// Vertices of cloth on a prescribed motion.
    #[strum(serialize = "grips")]
    Grips,
    /// Impacts with a material's coefficient of restitution.
    #[strum(serialize = "restitution")]
    Restitution,
    /// Contact of cloth with cloth.
    #[strum(serialize = "contact of cloth with cloth")]
    ClothContact,
    /// Cloths worn over one another in a given order.
    #[strum(serialize = "layers")]
    Layers,
    /// Damping proportional to mass.
    #[strum(serialize = "drag per mass")]
    MassDrag,
    /// Drag of air and wind on triangles.
    #[strum(serialize = "air and wind on triangles")]
    TriangleDrag,
    /// Viscosity, of a material or proportional to stiffness.
    #[strum(serialize = "viscosity")]
    Viscosity,
    /// Stretch and folds that relax (internal strain).
    #[strum(serialize = "kept strain and folds")]
    KeptStrain,
    /// Stretch stiffness that grows with strain.
    #[strum(serialize = "hardening")]
    Hardening,
    /// A limit of stretch.
    #[strum(serialize = "strain limit")]
    StrainLimit,
    /// Cloth without resistance to compression.
    #[strum(serialize = "tension field")]
    TensionField,
}

impl Feature {
    /// All features with their names in messages and documentation.
    pub const ALL: [(&'static str, Self); Self::COUNT] = toile_geometry::named_variants!();

    /// Its name in messages and documentation.
    pub fn name(self) -> &'static str {
        let found = Self::ALL.iter().find(|(_, feature)| *feature == self);
        found.map_or("", |(name, _)| name)
    }

    /// Whether it only dissipates energy of motion and has no effect on equilibrium.
    pub fn only_damps(self) -> bool {
        matches!(self, Self::MassDrag | Self::Viscosity)
    }

    /// The field of a scene file by which a world uses the feature; none where it does not.
    pub fn asked_by(self, world: &World) -> Option<String> {
        let environment = world.environment();
        match self {
            Self::MovingObjects => {
                let (_, object) = world.objects().find(|(_, o)| o.kind == Kind::Animated)?;
                Some(format!("motion of \"{}\"", object.name))
            }
            Self::Grips => {
                let grips = |o: &Object| o.kind == Kind::Deformable && !o.grips.is_empty();
                let (_, object) = world.objects().find(|(_, object)| grips(object))?;
                Some(format!("grips of \"{}\"", object.name))
            }
            Self::Restitution => cloth(world, "restitution", |m| m.restitution.is_some()),
            Self::ClothContact => {
                let apart = environment.contact.cloth_offset > 0.0;
                apart.then(|| "collision.cloth_offset".to_owned())
            }
            Self::Layers => {
                let mut cloths = world.objects().filter(|(_, o)| o.kind == Kind::Deformable);
                let (_, first) = cloths.next()?;
                let (_, other) = cloths.find(|(_, object)| object.layers != first.layers)?;
                Some(format!("layer of \"{}\"", other.name))
            }
            Self::MassDrag => match (environment.air.drag > 0.0, environment.damping.mass > 0.0) {
                (true, _) => Some("air.drag".to_owned()),
                (false, true) => Some("damping.mass".to_owned()),
                (false, false) => None,
            },
            Self::TriangleDrag => (environment.air.acts()).then(|| "air.density".to_owned()),
            Self::Viscosity if environment.damping.stiffness > 0.0 => {
                Some("damping.stiffness".to_owned())
            }
            Self::Viscosity => cloth(world, "viscosity", |m| m.is_viscous().contains(&true)),
            Self::KeptStrain => cloth(world, "kept share", DissipativeLaws::keeps_strain),
            Self::Hardening => cloth(world, "hardening", |m| m.hardening.iter().any(|&k| k > 0.0)),
            Self::StrainLimit => cloth(world, "strain limit", |m| {
                m.strain_limit.iter().any(|limit| limit.is_finite())
            }),
            Self::TensionField => cloth(world, "compression", |m| {
                m.compression == Compression::TensionField
            }),
        }
    }
}

/// Names the first cloth with a material that `has` a property; `what` is the name of the property.
fn cloth(world: &World, what: &str, has: impl Fn(&Material) -> bool) -> Option<String> {
    let (id, _) = (world.cloths()).find(|(_, cloth)| cloth.materials.iter().any(&has))?;
    let object = world.object(id)?;
    Some(format!("{what} of \"{}\"", object.name))
}

impl MethodKind {
    /// Whether the method supports a feature.
    pub fn supports(self, feature: Feature) -> bool {
        match feature {
            Feature::MovingObjects | Feature::Grips | Feature::Restitution => self == Self::Xpbd,
            Feature::ClothContact | Feature::Layers => matches!(
                self,
                Self::Xpbd | Self::ImplicitEuler | Self::Bdf2 | Self::ImplicitMidpoint | Self::Rest
            ),
            // Equilibrium methods have no time over which strain could relax.
            Feature::KeptStrain => !self.is_equilibrium() && self != Self::Xpbd,
            Feature::MassDrag
            | Feature::TriangleDrag
            | Feature::Viscosity
            | Feature::Hardening
            | Feature::StrainLimit
            | Feature::TensionField => true,
        }
    }
}

impl World {
    /// Refuses a world with a feature that a method does not support.
    pub(crate) fn check_features(&self, kind: MethodKind) -> Result<(), DrapeError> {
        let all = Feature::ALL.iter().map(|&(_, feature)| feature);
        let asked = all.filter_map(|feature| Some((feature, feature.asked_by(self)?)));
        let asked: Vec<(Feature, String)> = asked.collect();
        let Some((feature, place)) = asked.iter().find(|(feature, _)| !kind.supports(*feature))
        else {
            return Ok(());
        };
        let names = |able: &dyn Fn(MethodKind) -> bool| {
            let able = MethodKind::ALL.iter().filter(|(_, kind)| able(*kind));
            able.map(|&(name, _)| name).collect::<Vec<_>>().join(", ")
        };
        let whole = names(&|kind| asked.iter().all(|(feature, _)| kind.supports(*feature)));
        let remedy = match whole.is_empty() {
            false => format!("leave it out, or use a method that knows it: {whole}"),
            true => {
                let knowing = names(&|kind| kind.supports(*feature));
                let asked: Vec<_> = asked.iter().map(|(feature, _)| feature.name()).collect();
                format!(
                    "leave it out: {knowing} knows it, but no method knows all that is asked for here ({})",
                    asked.join(", ")
                )
            }
        };
        Err(DrapeError::Scene {
            place: place.clone(),
            what: format!("method \"{}\" knows no {}", kind.name(), feature.name()),
            remedy,
        })
    }
}
