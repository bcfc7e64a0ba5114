//! A library of fabrics: published figures with their sources, none fitted to a drape.
//!
//! A figure is either measured on one cloth ("measured"), the mean of many ("mean of 214"), or a
//! round figure inside a published range of its kind ("range"). Where a test has no value for the bias, it is the
//! mean of warp and weft (see [`KesValues::material`](crate::KesValues::material)).

use crate::kes::{bending, bending_of_length, shear, tensile_curve, weight};
use crate::material::Material;
use crate::sources::FabricSources;

/// A fabric of the library.
#[derive(Clone, Copy, Debug)]
pub struct LibraryFabric {
    /// Name in files and on the command line.
    pub name: &'static str,
    /// A short description.
    pub about: &'static str,
    /// A colour such cloth is often seen in: red, green and blue of sRGB, 0 to 1.
    pub colour: [f64; 3],
    /// Mass per area (kg/m2).
    pub density: f64,
    /// Thickness (m).
    pub thickness: f64,
    /// Stiffness (N/m) and hardening of warp and weft.
    pub stretch: [(f64, f64); 2],
    /// Shear stiffness (N/m).
    pub shear: f64,
    /// Poisson ratio.
    pub poisson: f64,
    /// Bending stiffness along warp, weft and bias (N m).
    pub bend: [f64; 3],
    /// Coulomb friction coefficient (1).
    pub friction: f64,
    /// Sources of the figures.
    pub sources: FabricSources,
}

impl LibraryFabric {
    /// The fabric of that name.
    pub fn named(name: &str) -> Option<&'static Self> {
        LIBRARY.iter().find(|fabric| fabric.name == name)
    }

    /// The material. `stretch` is the stiffness of a specimen clamped across, as in the tests, that of a material is
    /// the stiffness of a strip that is free to contract: hence the factor 1 - nu^2.
    pub fn material(&self) -> Material {
        let free = 1.0 - self.poisson * self.poisson;
        Material {
            density: self.density,
            thickness: self.thickness,
            stretch: self.stretch.map(|(stiffness, _)| stiffness * free),
            hardening: self.stretch.map(|(_, hardening)| hardening),
            shear: self.shear,
            poisson: self.poisson,
            bend: self.bend,
            friction: self.friction,
            ..Material::default()
        }
    }
}

const KES_RANGE: &str = "range: Kawabata 1980, The Standardization and Analysis of Hand Evaluation, apparel fabrics \
     (B 0.02-0.3 gf cm2/cm, G 0.3-3 gf/(cm deg), EM 2-10 %, LT 0.5-0.8)";
const SUITING: &str = "mean of 214 winter suitings: Kawabata 1980, The Standardization and Analysis of Hand \
     Evaluation, table of KN-101 means (log10 B -0.8673, log10 G -0.0143, LT 0.6082, log10 WT 0.9621, \
     log10 T -0.1272, log10 W 1.4208, MIU 0.2085)";
const DENIM: &str = "mean of six denims of regenerated cellulose: Kumari and Khurana 2016, Journal of \
                     Textiles, article 4614168, table 5 \
                     (G 1.50-3.40, EMT 4.70-5.74 %, LT 0.655-0.780, T 0.80-1.19 mm)";
const COTTON_DENIM: &str = "measured: Mondal and Khan 2014, Fashion and Textiles 1:19, table 1, trousers of \
     cotton twill washed with 2 % of enzyme, 334 g/m2, stiffness 2.62 cm, read as the bending length; \
     one direction, not named";
/// Mass per area (kg/m2) and bending length (m) of that.
const WASHED_DENIM: (f64, f64) = (0.334, 0.0262);
const QUANTILES: &str = "5 % quantiles of 618 fabrics: Feng, Huang, Xu, Wang 2022, Learning-based \
                         Bending Stiffness Parameter Estimation by a Drape Tester, data set";
const MEDIANS: &str = "medians of 618 fabrics: Feng, Huang, Xu, Wang 2022, Learning-based Bending \
                       Stiffness Parameter Estimation by a Drape Tester, data set";
const SKIN: &str =
    "range: Derler and Gerhardt 2012, Tribology of skin, textiles on dry skin, 0.2-0.5";

const fn sources(
    density: &'static str,
    thickness: &'static str,
    stretch: &'static str,
    shear: &'static str,
    bend: &'static str,
) -> FabricSources {
    FabricSources {
        density,
        thickness,
        stretch,
        shear,
        bend,
        friction: SKIN,
    }
}

/// Bending along warp, weft, and their mean along the bias, from B in gf cm2/cm.
const fn kes_bend(warp: f64, weft: f64) -> [f64; 3] {
    let (warp, weft) = (bending(warp), bending(weft));
    [warp, weft, 0.5 * (warp + weft)]
}

/// Every fabric of the library.
pub static LIBRARY: [LibraryFabric; 10] = [
    LibraryFabric {
        name: "silk",
        about: "crepe de Chine of 16 momme",
        colour: [0.93, 0.87, 0.76],
        density: 0.069,
        thickness: 0.20e-3,
        stretch: [tensile_curve(4.0, 0.65), tensile_curve(6.0, 0.60)],
        shear: shear(0.35),
        poisson: 0.2,
        bend: kes_bend(0.03, 0.02),
        friction: 0.25,
        sources: sources(
            "trade weight: 16 momme of 4.34 g/m2",
            "range: silk crepes, 0.15-0.25 mm",
            KES_RANGE,
            KES_RANGE,
            KES_RANGE,
        ),
    },
    LibraryFabric {
        name: "chiffon",
        about: "silk chiffon of 7 momme",
        colour: [0.92, 0.80, 0.80],
        density: 0.031,
        thickness: 0.15e-3,
        stretch: [tensile_curve(6.0, 0.60), tensile_curve(8.0, 0.60)],
        shear: shear(0.3),
        poisson: 0.2,
        bend: [1.1e-6, 0.9e-6, 0.9e-6],
        friction: 0.25,
        sources: sources(
            QUANTILES,
            "range: silk chiffons, 0.1-0.2 mm",
            KES_RANGE,
            KES_RANGE,
            QUANTILES,
        ),
    },
    LibraryFabric {
        name: "poplin",
        about: "cotton poplin, shirting",
        colour: [0.72, 0.81, 0.90],
        density: 0.12,
        thickness: 0.30e-3,
        stretch: [tensile_curve(3.0, 0.75), tensile_curve(6.0, 0.70)],
        shear: shear(1.2),
        poisson: 0.2,
        bend: kes_bend(0.10, 0.06),
        friction: 0.4,
        sources: sources(
            "trade weight: shirting poplin, 110-130 g/m2",
            "range: shirtings, 0.25-0.35 mm",
            KES_RANGE,
            KES_RANGE,
            KES_RANGE,
        ),
    },
    LibraryFabric {
        name: "cotton",
        about: "a plain cotton weave of middling weight",
        colour: [0.95, 0.94, 0.90],
        density: 0.197,
        thickness: 0.45e-3,
        stretch: [tensile_curve(4.0, 0.72), tensile_curve(7.0, 0.68)],
        shear: shear(1.5),
        poisson: 0.2,
        bend: [13.8e-6, 8.8e-6, 11.5e-6],
        friction: 0.4,
        sources: sources(
            MEDIANS,
            "range: cotton weaves of 200 g/m2, 0.4-0.5 mm",
            KES_RANGE,
            KES_RANGE,
            MEDIANS,
        ),
    },
    LibraryFabric {
        name: "jersey",
        about: "single cotton jersey; warp is the wale",
        colour: [0.55, 0.60, 0.66],
        density: 0.16,
        thickness: 0.70e-3,
        stretch: [(150.0, 0.0), (60.0, 0.0)],
        shear: shear(0.6),
        poisson: 0.3,
        bend: kes_bend(0.05, 0.03),
        friction: 0.4,
        sources: sources(
            "trade weight: T-shirt jersey, 140-180 g/m2",
            "range: single jerseys, 0.6-0.8 mm",
            "range: Wang, O'Brien, Ramamoorthi 2011, Data-Driven Elastic Models for Cloth, knits at \
             small strain, 30-200 N/m",
            KES_RANGE,
            KES_RANGE,
        ),
    },
    LibraryFabric {
        name: "wool",
        about: "worsted winter suiting",
        colour: [0.40, 0.35, 0.33],
        density: weight(26.35),
        thickness: 0.746e-3,
        stretch: [tensile_curve(6.03, 0.608), tensile_curve(6.03, 0.608)],
        shear: shear(0.968),
        poisson: 0.2,
        bend: kes_bend(0.136, 0.136),
        friction: 0.3,
        sources: sources(SUITING, SUITING, SUITING, SUITING, SUITING),
    },
    LibraryFabric {
        name: "denim",
        about: "washed cotton denim of 10 oz",
        colour: [0.24, 0.32, 0.47],
        density: WASHED_DENIM.0,
        thickness: 0.993e-3,
        stretch: [tensile_curve(5.21, 0.70), tensile_curve(5.21, 0.70)],
        shear: shear(1.96),
        poisson: 0.2,
        bend: [bending_of_length(WASHED_DENIM.0, WASHED_DENIM.1); 3],
        friction: 0.45,
        sources: sources(COTTON_DENIM, DENIM, DENIM, DENIM, COTTON_DENIM),
    },
    LibraryFabric {
        name: "leather",
        about: "sheep garment leather",
        colour: [0.42, 0.26, 0.17],
        density: 0.50,
        thickness: 0.80e-3,
        stretch: [(8.0e3, 0.0), (8.0e3, 0.0)],
        shear: 2.9e3,
        poisson: 0.4,
        bend: [1.56e-4, 1.56e-4, 1.56e-4],
        friction: 0.4,
        sources: sources(
            "range: garment leathers of 0.6-0.7 g/cm3",
            "middle of 0.64-0.96 mm: Memon et al. 2021, Materials 14(16) 4553",
            "range: initial modulus of garment nappa about 10 MPa, times the thickness",
            "isotropic: Y / (2 (1 + nu))",
            "middle of 9.2-22: Memon et al. 2021, Materials 14(16) 4553, abstract; read as mN cm, the \
             unit of the cantilever test",
        ),
    },
    LibraryFabric {
        name: "felt",
        about: "pressed wool felt of 1 mm",
        colour: [0.45, 0.50, 0.32],
        density: 0.20,
        thickness: 1.0e-3,
        stretch: [(2.0e3, 0.0), (2.0e3, 0.0)],
        shear: 0.77e3,
        poisson: 0.3,
        bend: [8.0e-5, 8.0e-5, 8.0e-5],
        friction: 0.5,
        sources: sources(
            "trade grade: pressed wool felt of 0.20 g/cm3",
            "trade grade: 1 mm",
            "range: soft pressed felts, 1-5 MPa at small strain, times the thickness",
            "isotropic: Y / (2 (1 + nu))",
            "half of Y t^2 / 12, the bound of a sheet whose fibres do not slip",
        ),
    },
    LibraryFabric {
        name: "flag-nylon",
        about: "woven flag nylon of 1.6 oz",
        colour: [0.75, 0.18, 0.17],
        density: 0.054,
        thickness: 0.10e-3,
        stretch: [tensile_curve(3.0, 0.80), tensile_curve(4.0, 0.80)],
        shear: shear(1.0),
        poisson: 0.2,
        bend: kes_bend(0.03, 0.03),
        friction: 0.25,
        sources: sources(
            "MIL-C-7020 type III, ripstop: 1.6 oz/yd2",
            "MIL-C-7020 type II, a twill of the same weight: 0.004 in",
            KES_RANGE,
            KES_RANGE,
            KES_RANGE,
        ),
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_fabric_can_be_simulated_and_names_its_sources() {
        for fabric in &LIBRARY {
            fabric.material().in_domain().unwrap();
            let s = fabric.sources;
            for source in [
                s.density,
                s.thickness,
                s.stretch,
                s.shear,
                s.bend,
                s.friction,
            ] {
                assert!(source.len() > 12, "{}", fabric.name);
            }
            let same = LIBRARY.iter().filter(|other| other.name == fabric.name);
            assert_eq!(same.count(), 1);
            assert!(LibraryFabric::named(fabric.name).is_some());
        }
        assert!(LibraryFabric::named("unobtainium").is_none());
    }

    #[test]
    fn figures_lie_in_the_span_of_measured_fabrics() {
        for fabric in &LIBRARY {
            let m = fabric.material();
            assert!((0.02..0.6).contains(&m.density), "{}", fabric.name);
            let bending_length = (m.bend[0] / (m.density * 9.81)).cbrt();
            // 5 and 95 % of 618 fabrics: 10.6 and 32.9 mm; felt and leather may be a little stiffer.
            assert!(
                (0.0105..0.036).contains(&bending_length),
                "{}: {bending_length}",
                fabric.name
            );
        }
    }
}
