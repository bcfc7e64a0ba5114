//! Fields of the names of corners and lines, and of marks on a line.

use super::{Choice, ITSELF, Told, group, key, length, plain};
use crate::{AnyId, Mark, Name, OperationId, Role, fields};
use strum::IntoEnumIterator;

impl Choice for Role {}

impl<Id: Clone + Default> IntoEnumIterator for Name<Id> {
    type Iterator = std::array::IntoIter<Self, 2>;

    fn iter() -> Self::Iterator {
        let made = Self::Made {
            by: OperationId::default(),
            role: Role::default(),
            index: 0,
        };
        [Self::default(), made].into_iter()
    }
}

fields!(
    @[Id: AnyId + Clone + Default] Name<Id>,
    |self, v| {
        match self {
            Self::Drawn(id) => v.id(ITSELF, id),
            Self::Made { by, role, index } => {
                v.id("by", by);
                v.value(key("role"), role);
                v.value(key("index").beyond("there are not that many", "write a smaller index"), index);
            }
        }
    },
    kinds: |name| match name {
        Name::Drawn(_) => Told::Number,
        Name::Made { .. } => Told::By(&[]),
    }
);

fields!(
    Mark,
    |self, v| {
        match self {
            Self::Notch(id) => v.id("notch", id),
            Self::Along { from, distance } => {
                v.part(group("from"), from);
                v.number(length("distance"), distance);
            }
            Self::Between { ends: [from, to], share } => {
                v.list(group("between"), &mut |v| {
                    v.part(group("after"), from);
                    v.part(group("before"), to);
                });
                v.number(plain("share").label("part of the edge"), share);
            }
            Self::Corner(corner) => v.flat(corner),
        }
    },
    kinds: |mark| match mark {
        Mark::Notch(_) => Told::By(&["notch"]),
        Mark::Along { .. } => Told::By(&["from"]),
        Mark::Between { .. } => Told::By(&["between"]),
        Mark::Corner(_) => Told::By(&["by"]),
    }
);
