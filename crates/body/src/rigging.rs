//! Properties of single primitives of a body: the joint one is fixed to, its change with a reference joint,
//! and groups of primitives.

use crate::deform::Deformation;
use crate::{BodyError, Joint};
use serde::{Deserialize, Serialize};

/// Properties of one primitive that differ from the default.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Particular {
    /// Number of the primitive, in the order of [`crate::Description::primitives`].
    pub primitive: usize,
    /// The joint that the primitive is fixed to; `None` for the joint of the bone that the primitive lies
    /// round.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub joint: Option<Joint>,
    /// Change with a reference joint; `None` for a rigid primitive.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub deformation: Option<Deformation>,
}

/// Properties of the primitives of a body that differ from the default.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rigging {
    /// Properties by rising number of the primitive; primitives with default properties are left out.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub particulars: Vec<Particular>,
    /// Sets of primitives that are moved and turned together: numbers in ascending order, each primitive in
    /// one set at most.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub joined: Vec<Vec<usize>>,
}

impl Rigging {
    /// Whether all primitives have default properties and none are joined.
    pub fn is_empty(&self) -> bool {
        self.particulars.is_empty() && self.joined.is_empty()
    }

    /// The properties of a primitive that differ from the default.
    pub fn of(&self, primitive: usize) -> Option<&Particular> {
        let found = self
            .particulars
            .binary_search_by_key(&primitive, |p| p.primitive);
        found.ok().map(|k| &self.particulars[k])
    }

    /// Changes the properties of a primitive.
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

    /// Removes a deleted primitive; the numbers of later ones decrease by one.
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

    /// Joins primitives, together with the primitives that they were joined with before.
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

    /// Takes primitives out of the sets that they are joined in.
    pub(crate) fn part(&mut self, primitives: &[usize]) {
        for set in &mut self.joined {
            set.retain(|k| !primitives.contains(k));
        }
        self.joined.retain(|set| set.len() > 1);
    }

    /// The primitive and all primitives that it is joined with.
    pub(crate) fn together(&self, primitive: usize) -> Vec<usize> {
        let set = self.joined.iter().find(|set| set.contains(&primitive));
        set.cloned().unwrap_or_else(|| vec![primitive])
    }

    /// Refuses numbers of primitives that do not exist, repeated or unsorted numbers, and bad deformations.
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
