//! Edits of the primitives of a body, as data (the primitive editor of Volino, Magnenat-Thalmann, Shen,
//! Thalmann 1996). Values are absolute, not changes. To undo an edit, the description from before it is used
//! again.

use crate::deform::Deformation;
use crate::describe::check;
use crate::template::Template;
use crate::{Blend, BodyError, Description, Joint, Part, Primitive};
use nalgebra::Rotation3;
use serde::{Deserialize, Serialize};
use toile_geometry::Vec3;

/// One change of a body's primitives. Primitives are counted from 0 in the order of
/// [`Description::primitives`]: those of the left side and the median plane; one off the median plane stands
/// for itself and its mirror image.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "edit", deny_unknown_fields)]
pub enum PrimitiveEdit {
    /// Adds a primitive after the others.
    Create {
        /// The new primitive.
        new: Primitive,
    },
    /// Removes a primitive; the numbers of later ones decrease by one.
    Delete {
        /// Number of the primitive.
        primitive: usize,
    },
    /// Moves the centre of a primitive to a point; primitives joined with it are moved along.
    Move {
        /// Number of the primitive.
        primitive: usize,
        /// The centre (m).
        centre: [f64; 3],
    },
    /// Turns a primitive; primitives joined with it turn about its centre.
    Turn {
        /// Number of the primitive.
        primitive: usize,
        /// The rotation as axis times angle (rad).
        rotation: [f64; 3],
    },
    /// Gives a primitive other semi-axes.
    Scale {
        /// Number of the primitive.
        primitive: usize,
        /// The effective semi-axes (m).
        radii: [f64; 3],
    },
    /// Gives a primitive another weight.
    Weigh {
        /// Number of the primitive.
        primitive: usize,
        /// Factor of the density (1).
        weight: f64,
    },
    /// Puts a primitive into one group, or into two.
    Group {
        /// Number of the primitive.
        primitive: usize,
        /// The first part: trunk, head, left arm or left leg.
        part: Part,
        /// A second part.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        also: Option<Part>,
    },
    /// Makes a primitive blendable or unblendable.
    Blend {
        /// Number of the primitive.
        primitive: usize,
        /// Kind of blending with the others.
        blend: Blend,
    },
    /// Makes a primitive change with a reference joint, or makes it rigid.
    Deform {
        /// Number of the primitive.
        primitive: usize,
        /// The deformation; `None` makes the primitive rigid.
        deformation: Option<Deformation>,
    },
    /// Fixes a primitive to a joint.
    Attach {
        /// Number of the primitive.
        primitive: usize,
        /// The joint.
        joint: Joint,
    },
    /// Fixes a primitive again to the bone that it lies round.
    Detach {
        /// Number of the primitive.
        primitive: usize,
    },
    /// Joins primitives: they are moved and turned together from then on.
    Join {
        /// Numbers of the primitives, at least two.
        primitives: Vec<usize>,
    },
    /// Takes primitives out of the set that they are joined in.
    Part {
        /// Numbers of the primitives.
        primitives: Vec<usize>,
    },
}

/// Largest number of primitives of the left side and the median plane: five times those of a fitted body.
const MOST: usize = 400;

impl Description {
    /// The description with its primitives written out; if it lists no primitives, those of its figure.
    pub fn with_primitives(&self) -> Self {
        let mut next = self.clone();
        if next.primitives.is_empty() {
            next.primitives = Template::of(self.figure)
                .primitives
                .into_iter()
                .filter(|p| !p.is_right())
                .collect();
        }
        next
    }

    /// The description with all edits applied in order; if one edit is refused, none is applied. Whether a
    /// skin can still be cast on the primitives is only known when a [`crate::Mannequin`] is made.
    ///
    /// # Errors
    /// [`BodyError::Description`] for a primitive that does not exist, or values that no primitive can have,
    /// with the remedy.
    pub fn edited(&self, edits: &[PrimitiveEdit]) -> Result<Self, BodyError> {
        let mut next = self.with_primitives();
        for edit in edits {
            next.edit(edit)?;
        }
        Ok(next)
    }

    fn edit(&mut self, edit: &PrimitiveEdit) -> Result<(), BodyError> {
        match edit {
            PrimitiveEdit::Create { new } => {
                if self.primitives.len() >= MOST {
                    return refused("there are 400 primitives: delete some first");
                }
                self.primitives.push(*new);
            }
            PrimitiveEdit::Delete { primitive } => {
                let part = self.own(*primitive)?.part;
                let left = self.primitives.iter().filter(|p| p.part == part).count();
                if left == 1 {
                    return refused("the last primitive of a part cannot be deleted: move it");
                }
                self.primitives.remove(*primitive);
                self.rigging.forget(*primitive);
            }
            PrimitiveEdit::Move { primitive, centre } => {
                let by = Vec3::from(*centre) - Vec3::from(self.own(*primitive)?.centre);
                for other in self.rigging.together(*primitive) {
                    let own = self.own(other)?;
                    own.centre = (Vec3::from(own.centre) + by).into();
                }
                // The exact numbers asked for, without rounding.
                self.own(*primitive)?.centre = *centre;
            }
            PrimitiveEdit::Turn {
                primitive,
                rotation,
            } => self.turn(*primitive, *rotation)?,
            PrimitiveEdit::Scale { primitive, radii } => self.own(*primitive)?.radii = *radii,
            PrimitiveEdit::Weigh { primitive, weight } => self.own(*primitive)?.weight = *weight,
            PrimitiveEdit::Group {
                primitive,
                part,
                also,
            } => {
                let own = self.own(*primitive)?;
                own.part = *part;
                own.also = also.filter(|other| other != part);
            }
            PrimitiveEdit::Blend { primitive, blend } => self.own(*primitive)?.blend = *blend,
            PrimitiveEdit::Deform { .. }
            | PrimitiveEdit::Attach { .. }
            | PrimitiveEdit::Detach { .. }
            | PrimitiveEdit::Join { .. }
            | PrimitiveEdit::Part { .. } => self.rig(edit)?,
        }
        for (index, primitive) in self.primitives.iter().enumerate() {
            check(index, primitive)?;
        }
        Ok(())
    }

    fn rig(&mut self, edit: &PrimitiveEdit) -> Result<(), BodyError> {
        match edit {
            PrimitiveEdit::Deform {
                primitive,
                deformation,
            } => {
                self.own(*primitive)?;
                if let Some(deformation) = deformation {
                    deformation.check()?;
                }
                let to = deformation.clone();
                self.rigging.change(*primitive, |own| own.deformation = to);
            }
            PrimitiveEdit::Attach { primitive, joint } => {
                self.own(*primitive)?;
                let to = Some(*joint);
                self.rigging.change(*primitive, |own| own.joint = to);
            }
            PrimitiveEdit::Detach { primitive } => {
                self.own(*primitive)?;
                self.rigging.change(*primitive, |own| own.joint = None);
            }
            PrimitiveEdit::Join { primitives } | PrimitiveEdit::Part { primitives } => {
                for &primitive in primitives {
                    self.own(primitive)?;
                }
                let mut named = primitives.clone();
                named.sort_unstable();
                named.dedup();
                match edit {
                    PrimitiveEdit::Join { .. } if named.len() < 2 => {
                        return refused("two primitives at least are joined: name them");
                    }
                    PrimitiveEdit::Join { .. } => self.rigging.join(&named),
                    _ => self.rigging.part(&named),
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn own(&mut self, primitive: usize) -> Result<&mut Primitive, BodyError> {
        let count = self.primitives.len();
        self.primitives.get_mut(primitive).ok_or_else(|| {
            BodyError::Description(format!(
                "there is no primitive {primitive}: they are counted from 0 to {}",
                count.saturating_sub(1)
            ))
        })
    }

    fn turn(&mut self, primitive: usize, rotation: [f64; 3]) -> Result<(), BodyError> {
        let own = *self.own(primitive)?;
        let by = Rotation3::new(Vec3::from(rotation)) * own.rotation().inverse();
        let about = Vec3::from(own.centre);
        for other in self.rigging.together(primitive) {
            let own = self.own(other)?;
            own.centre = (about + by * (Vec3::from(own.centre) - about)).into();
            own.rotation = (by * own.rotation()).scaled_axis().into();
        }
        let own = self.own(primitive)?;
        (own.centre, own.rotation) = (about.into(), rotation);
        Ok(())
    }
}

fn refused(why: &str) -> Result<(), BodyError> {
    Err(BodyError::Description(why.to_owned()))
}
