//! Properties of single primitives of a body: the joint one is fixed to, its change with a reference joint,
//! and groups of primitives.

use crate::deform::Deformation;
use crate::{BodyError, Joint};
use serde::{Deserialize, Serialize};

/// What is particular about one primitive.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Particular {
    /// Which, in the order of [`crate::Description::primitives`].
    pub primitive: usize,
    /// The joint it is fixed to; none for that of the bone it lies round.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub joint: Option<Joint>,
    /// How it changes with a reference joint; none for a rigid one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub deformation: Option<Deformation>,
}

/// What is particular about the primitives of a body.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rigging {
    /// By rising number; those with nothing particular are left out.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub particulars: Vec<Particular>,
    /// Sets of primitives that are moved and turned together: numbers rise, no number twice.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub joined: Vec<Vec<usize>>,
}

impl Rigging {
    /// Whether nothing is particular.
    pub fn is_empty(&self) -> bool {
        self.particulars.is_empty() && self.joined.is_empty()
    }

    /// What is particular about a primitive.
    pub fn of(&self, primitive: usize) -> Option<&Particular> {
        let found = self
            .particulars
            .binary_search_by_key(&primitive, |p| p.primitive);
        found.ok().map(|k| &self.particulars[k])
    }

    /// Changes what is particular about a primitive.
    pub(crate) fn change(&mut self, primitive: usize, change: impl FnOnce(&mut Particular)) {
        let found = self
            .particulars
            .binary_search_by_key(&primitive, |p| p.primitive);
        let place = found.unwrap_or_else(|place| {
            let own = Particular {
                primitive,
                ..Particular::default()
            };
            self.particulars.insert(place, own);
            place
        });
        let own = &mut self.particulars[place];
        change(own);
        if own.joint.is_none() && own.deformation.is_none() {
            self.particulars.remove(place);
        }
    }

    /// Forgets a primitive that is deleted; later ones move up.
    pub(crate) fn forget(&mut self, primitive: usize) {
        self.particulars.retain(|p| p.primitive != primitive);
        for own in &mut self.particulars {
            own.primitive -= usize::from(own.primitive > primitive);
        }
        self.part(&[primitive]);
        for number in self.joined.iter_mut().flatten() {
            *number -= usize::from(*number > primitive);
        }
    }

    /// Joins primitives, and what they were joined with before.
    pub(crate) fn join(&mut self, primitives: &[usize]) {
        let (mut one, others): (Vec<Vec<usize>>, Vec<Vec<usize>>) =
            std::mem::take(&mut self.joined)
                .into_iter()
                .partition(|set| set.iter().any(|k| primitives.contains(k)));
        one.push(primitives.to_vec());
        let mut all = one.concat();
        all.sort_unstable();
        all.dedup();
        self.joined = others;
        self.joined.push(all);
        self.joined.sort();
    }

    /// Takes primitives out of the sets they are joined in.
    pub(crate) fn part(&mut self, primitives: &[usize]) {
        for set in &mut self.joined {
            set.retain(|k| !primitives.contains(k));
        }
        self.joined.retain(|set| set.len() > 1);
    }

    /// A primitive with all it is joined with.
    pub(crate) fn together(&self, primitive: usize) -> Vec<usize> {
        let set = self.joined.iter().find(|set| set.contains(&primitive));
        set.cloned().unwrap_or_else(|| vec![primitive])
    }

    /// Refuses what points nowhere or means nothing.
    pub(crate) fn check(&self, count: usize) -> Result<(), BodyError> {
        let bad = |what: String| Err(BodyError::Description(what));
        let numbers = self
            .particulars
            .iter()
            .map(|p| p.primitive)
            .chain(self.joined.iter().flatten().copied());
        if let Some(lost) = numbers.clone().find(|&k| k >= count) {
            return bad(format!(
                "something is said of primitive {lost}, but there are {count}: count from 0"
            ));
        }
        let rising = |all: &[usize]| all.windows(2).all(|w| w[0] < w[1]);
        let named: Vec<usize> = self.particulars.iter().map(|p| p.primitive).collect();
        let mut joined = self.joined.concat();
        joined.sort_unstable();
        if !rising(&named) || !rising(&joined) || !self.joined.iter().all(|set| rising(set)) {
            return bad("a primitive is named twice or out of order: sort the numbers".into());
        }
        for own in &self.particulars {
            if let Some(deformation) = &own.deformation {
                deformation.check()?;
            }
        }
        Ok(())
    }
}
