//! The verdict on a simulation: which of the things that a result ought to be it is, and what it is not, in words.

use serde::ser::SerializeMap;
use serde::{Deserialize, Serialize, Serializer};
use std::collections::BTreeMap;

/// What a verdict judges.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Aspect {
    /// Whether the net force is within its tolerance.
    Rest,
    /// Whether the wearer carries the garment.
    Body,
    /// Whether seams, and elastics that are to merge vertices, are closed.
    Seams,
    /// Whether seams join all of the garment.
    Parts,
    /// Whether cloth crosses cloth, or lies inside a solid.
    Tangle,
    /// Whether layers lie outside one another in their order.
    Layers,
    /// Whether the run was ended because it advanced too slowly.
    Pace,
    /// Whether a garment at rest hangs in a heap along a seam.
    Hang,
    /// Whether the cloth is stretched, or too short of ease to clear the body.
    Tightness,
    /// Whether the garment reaches below the floor.
    Length,
    /// Whether the garment was put on otherwise than its file says.
    Placement,
}

impl Aspect {
    /// Its name in reports, and the value there of a sound result.
    pub fn name(self) -> (&'static str, bool) {
        match self {
            Self::Rest => ("at_rest", true),
            Self::Body => ("on_body", true),
            Self::Seams => ("seams_closed", true),
            Self::Parts => ("in_one_part", true),
            Self::Tangle => ("tangled", false),
            Self::Layers => ("layers_in_order", true),
            Self::Pace => ("slowed", false),
            Self::Hang => ("crumpled", false),
            Self::Tightness => ("too_tight", false),
            Self::Length => ("too_long", false),
            Self::Placement => ("put_on_otherwise", false),
        }
    }

    /// What a result is that fails it, in a few words.
    fn failure(self) -> &'static str {
        match self {
            Self::Rest => "not at rest",
            Self::Body => "off the body",
            Self::Seams => "seams open",
            Self::Parts => "in parts",
            Self::Tangle => "tangled",
            Self::Layers => "layers out of order",
            Self::Pace => "slowed down",
            Self::Hang => "crumpled",
            Self::Tightness => "too tight",
            Self::Length => "too long",
            Self::Placement => "put on otherwise",
        }
    }
}

/// One thing that a result is not as it ought to be.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Finding {
    /// What it concerns.
    pub aspect: Aspect,
    /// Whether the result is not what was asked for. Others are told of a result that stands.
    pub is_bad: bool,
    /// What, where, how much, and what to do.
    pub words: String,
}

impl Finding {
    /// A result that is not what was asked for.
    pub fn bad(aspect: Aspect, words: impl Into<String>) -> Self {
        Self {
            aspect,
            is_bad: true,
            words: words.into(),
        }
    }

    /// A result that stands, with something to be told.
    pub fn told(aspect: Aspect, words: impl Into<String>) -> Self {
        Self {
            is_bad: false,
            ..Self::bad(aspect, words)
        }
    }
}

/// The verdict on a result. It serialises to one field for each aspect that was judged, `sound`, and the findings.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Verdict {
    /// For each aspect that was judged whether nothing was found.
    judged: BTreeMap<Aspect, bool>,
    findings: Vec<Finding>,
}

impl Verdict {
    /// Judges an aspect by what was found of it.
    pub fn judge(&mut self, aspect: Aspect, found: impl IntoIterator<Item = Finding>) {
        self.judged.entry(aspect).or_insert(true);
        self.extend(found);
    }

    /// Whether the result is what was asked for.
    pub fn is_sound(&self) -> bool {
        !self.findings.iter().any(|finding| finding.is_bad)
    }

    /// Whether an aspect is as it ought to be; none where it was not judged.
    pub fn passes(&self, aspect: Aspect) -> Option<bool> {
        self.judged.get(&aspect).copied()
    }

    /// What was found, bad findings first.
    pub fn findings(&self) -> &[Finding] {
        &self.findings
    }

    /// The words of all findings.
    pub fn words(&self) -> impl Iterator<Item = &str> {
        self.findings.iter().map(|finding| &*finding.words)
    }

    /// The failed aspects in a few words, bad ones first; nothing where nothing was found.
    pub fn headline(&self) -> String {
        let mut words: Vec<&str> = Vec::new();
        for finding in &self.findings {
            let failure = finding.aspect.failure();
            if !words.contains(&failure) {
                words.push(failure);
            }
        }
        words.join(", ")
    }
}

impl Extend<Finding> for Verdict {
    fn extend<I: IntoIterator<Item = Finding>>(&mut self, found: I) {
        for finding in found {
            self.judged.insert(finding.aspect, false);
            self.findings.push(finding);
        }
        self.findings.sort_by_key(|finding| !finding.is_bad);
    }
}

impl Serialize for Verdict {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("sound", &self.is_sound())?;
        for (aspect, &passes) in &self.judged {
            let (name, sound) = aspect.name();
            map.serialize_entry(name, &(passes == sound))?;
        }
        map.serialize_entry("findings", &self.findings)?;
        map.end()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_verdict_is_bad_by_one_bad_finding_which_stands_first() {
        let mut verdict = Verdict::default();
        verdict.judge(Aspect::Rest, None);
        let tight = Finding::told(Aspect::Tightness, "stretched by 20 %");
        verdict.judge(Aspect::Tightness, [tight]);
        assert!(verdict.is_sound());
        assert_eq!(verdict.headline(), "too tight");
        verdict.judge(Aspect::Body, [Finding::bad(Aspect::Body, "it fell")]);
        assert!(!verdict.is_sound());
        assert_eq!(verdict.headline(), "off the body, too tight");
        let words: Vec<&str> = verdict.words().collect();
        assert_eq!(words, ["it fell", "stretched by 20 %"]);
        assert_eq!(verdict.passes(Aspect::Rest), Some(true));
        assert_eq!(verdict.passes(Aspect::Body), Some(false));
        assert_eq!(verdict.passes(Aspect::Tangle), None);
    }
}
