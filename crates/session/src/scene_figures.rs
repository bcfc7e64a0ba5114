//! Figures of a scene: what they wear, and how they move.
//!
//! # Decided with
//! - [`crate::dressed_figure::DressedFigure::of`]: all that one wears, sewn and draped;
//! - [`crate::figure_track::FigureTrack::course`]: into the clip and through it;
//! - [`crate::clips::own_clip`], [`crate::clips::open_clip`]: clips by name, of files;
//! - [`toile_body::Player`], [`toile_body::Cleared`]: clips played; limbs kept apart;
//! - [`toile_geometry::Room`]: how far cloth keeps off in a pinch;
//! - [`toile_drape::Track`]: positions of the skin;
//! - [`crate::frame_counts::FrameCounts::add`]: what saved frames showed.
//!
//! The way into a clip: crate `body`, `lead_in.rs`. The skin against the cloth: crate `drape`,
//! `xpbd/skin_contacts.rs`, `xpbd/skin_edges.rs`, `xpbd/carried_plane.rs`.

use crate::clips::{open_clip, own_clip};
use crate::dressed_figure::DressedFigure;
use crate::figure_track::{Course, FigureMotion, FigureTrack};
use crate::scene_builder::Builder;
use crate::setup::CLOTH_OFFSET;
use crate::{SessionError, Watcher};
use std::sync::Arc;
use toile_body::{Clip, Mannequin, PlayError};
use toile_drape::{Air, ContactSettings, MethodKind, MethodSettings, ObjectKind, SharedTrack};
use toile_interchange::{FormatError, MotionFile, ObjectFile};

/// Time that figures stand still at the end of a scene without a duration (s).
const STANDS_STILL: f64 = 1.0;
/// Longest default substep of `xpbd` where garments are worn (s). A substep twice as long lengthens a
/// waistband of poplin by a quarter, so that a skirt slides off; one half as long changes a stretch of 12 %
/// by 2 percentage points.
const MAX_SUBSTEP: f64 = 1.0 / 2400.0;
/// Longest motion of a figure that is computed before its scene begins (s).
const MAX_COURSE_DURATION: f64 = 600.0;
/// Largest number of rounds of a looped clip; more are surely a mistake.
const MAX_STRIDES: f64 = 1000.0;

impl Builder<'_> {
    /// Dresses every body that wears something.
    ///
    /// # Errors
    /// Garments that cannot be sewn, and garments whose wearer is no body of the scene.
    pub(crate) fn dress(&mut self, watcher: &mut dyn Watcher) -> Result<(), SessionError> {
        let file = self.file;
        for (index, object) in file.objects.iter().enumerate() {
            self.check_worn(index, object)?;
        }
        for (index, object) in file.objects.iter().enumerate() {
            let dressed = DressedFigure::of(self.place, file, object, watcher)?;
            let Some(dressed) = dressed else { continue };
            self.figures.insert(index, dressed.body);
            self.garments.extend(dressed.garments);
            self.notes.extend(dressed.notes);
        }
        Ok(())
    }

    /// Refuses a garment whose wearer is no body, and fields that only a worn garment may have.
    fn check_worn(&self, index: usize, object: &ObjectFile) -> Result<(), SessionError> {
        let place = |field: &str| format!("objects[{index}].{field}");
        let Some(on) = &object.on else {
            if object.quality.is_some() {
                let what = "only a garment that is worn is made in a quality".to_owned();
                let remedy = "say who wears it, as in \"on\": \"woman\", or leave it out";
                return Err(self.place.wrong(place("quality"), what, remedy));
            }
            return Ok(());
        };
        let wearer = self.file.objects.iter().find(|other| other.name == *on);
        let refused = match wearer {
            None => Some(format!("there is no object \"{on}\"")),
            Some(wearer) if wearer.body.is_none() => Some(format!("\"{on}\" is no body")),
            Some(_) => None,
        };
        if let Some(what) = refused {
            let remedy = "name an object of the scene that has a body";
            return Err(self.place.wrong(place("on"), what, remedy));
        }
        if object.pattern.is_none() || object.kind != "deformable" {
            let what = "only the garment of a pattern is worn".to_owned();
            let remedy = "give a deformable object with a pattern, or leave \"on\" out";
            return Err(self.place.wrong(place("on"), what, remedy));
        }
        let usual = toile_interchange::TransformFile::default();
        let moved = &object.transform;
        let is_placed = moved.translation != usual.translation
            || moved.rotation != usual.rotation
            || moved.scale != usual.scale;
        if is_placed {
            let what = "a garment that is worn is where its wearer is".to_owned();
            let remedy = "give the transform to the wearer";
            return Err(self.place.wrong(place("transform"), what, remedy));
        }
        Ok(())
    }

    /// Contact as the file says. Unless it says otherwise, cloth also collides with cloth where garments are
    /// worn.
    pub(crate) fn contact(&self) -> ContactSettings {
        let mut contact = self.file.contact();
        if self.file.collision.cloth_offset.is_none() && self.is_worn() {
            contact.cloth_offset = CLOTH_OFFSET;
        }
        contact
    }

    /// The air as the file says. Unless it says otherwise, it has the density of air at sea level where
    /// garments are worn.
    pub(crate) fn air(&self) -> Air {
        let air = self.file.air.air();
        match self.file.air.density {
            None if self.is_worn() => Air {
                density: Air::SEA_LEVEL,
                ..air
            },
            _ => air,
        }
    }

    /// The method as the file says. Unless it says otherwise, the substeps of `xpbd` are short enough for
    /// tight cloth where garments are worn.
    ///
    /// # Errors
    /// An unknown method, settings out of range.
    pub(crate) fn method(&self) -> Result<MethodSettings, FormatError> {
        let mut method = self.file.method()?;
        if method.kind == MethodKind::Xpbd && method.substeps.is_none() && self.is_worn() {
            let substeps = (self.file.step / MAX_SUBSTEP).round();
            method.substeps = Some(substeps.clamp(1.0, f64::from(u16::MAX)) as u32);
        }
        Ok(method)
    }

    /// Whether any garment is worn.
    fn is_worn(&self) -> bool {
        self.file.objects.iter().any(|object| object.on.is_some())
    }

    /// The simulated time from 0 on (s).
    pub(crate) fn duration(&self) -> f64 {
        let usual = self.ends.map_or(1.0, |ends| ends + STANDS_STILL);
        self.file.duration.unwrap_or(usual)
    }

    /// Motion of a body that has a clip.
    ///
    /// # Errors
    /// A clip that cannot be read, numbers out of range, or a clip without lead-in that does not begin in the
    /// pose in which the figure is dressed.
    pub(crate) fn figure_kind(
        &mut self,
        index: usize,
        body: Arc<Mannequin>,
        motion: &MotionFile,
    ) -> Result<ObjectKind, SessionError> {
        let place = |field: &str| format!("objects[{index}].motion.{field}");
        let clip = self.clip(index, &body, motion)?;
        let asked = self.figure_motion(index, motion, &clip)?;
        let stands = motion.lead_in == Some(false);
        if stands && clip.poses.first().is_some_and(|first| !first.is_rest()) {
            let what =
                "the clip does not begin in the pose in which the figure is dressed".to_owned();
            let remedy = "leave it out: the figure then goes into the clip before time 0";
            return Err(self.place.wrong(place("lead_in"), what, remedy));
        }
        let round = clip.duration() / asked.rate.max(1e-3);
        let own = match clip.is_loop {
            true => asked.strides.map(|strides| strides * round + 0.5),
            false => Some(round + 0.5),
        };
        let ends = own.map(|own| own + STANDS_STILL);
        let posed = self.file.duration.or(ends).unwrap_or(1.0);
        if !(posed.is_finite() && posed <= MAX_COURSE_DURATION) {
            let what = format!(
                "the figure would move for {posed:.0} s; {MAX_COURSE_DURATION:.0} s are posed at most"
            );
            return Err(self
                .place
                .wrong(place("clip"), what, "give a shorter duration"));
        }
        let transform = self.file.objects[index].transform.clone();
        let span = (posed.max(0.0), self.file.step);
        let course = FigureTrack::course(body, clip, &asked, transform, span);
        let out_of_range = |error: PlayError| {
            self.place
                .wrong(place("rate"), error.to_string(), "correct it")
        };
        let Course {
            track,
            lead_in,
            ends,
            notes,
        } = course.map_err(out_of_range)?;
        let name = &self.file.objects[index].name;
        self.notes
            .extend(notes.iter().map(|note| format!("{name}: {note}")));
        self.lead_in = self.lead_in.max(lead_in);
        if let Some(ends) = ends {
            self.ends = Some(self.ends.map_or(ends, |other| other.max(ends)));
        }
        Ok(ObjectKind::tracked(SharedTrack::new(track)))
    }

    /// The clip that a motion names: one of the program's own, or a file named from the scene's folder.
    fn clip(
        &mut self,
        index: usize,
        body: &Mannequin,
        motion: &MotionFile,
    ) -> Result<Clip, SessionError> {
        let place = || format!("objects[{index}].motion.clip");
        let Some(name) = &motion.clip else {
            let what = "a body that moves needs a clip".to_owned();
            let remedy = "write walk, run, stand, astride, or a BVH, X3D or VRML file";
            return Err(self.place.wrong(place(), what, remedy));
        };
        let clip = match own_clip(name, body.skeleton()) {
            Some(own) => own,
            None => {
                let (clip, notes) = open_clip(&self.place.beside(name), body.skeleton())?;
                self.notes.extend(notes);
                clip
            }
        };
        match clip.poses.is_empty() {
            false => Ok(clip),
            true => {
                let what = format!("the clip \"{name}\" has no pose");
                Err(self
                    .place
                    .wrong(place(), what, "give one with a pose at least"))
            }
        }
    }

    fn figure_motion(
        &self,
        index: usize,
        motion: &MotionFile,
        clip: &Clip,
    ) -> Result<FigureMotion, SessionError> {
        let place = |field: &str| format!("objects[{index}].motion.{field}");
        if let Some(strides) = motion.strides {
            if !clip.is_loop {
                let what = "the clip is no loop that has strides".to_owned();
                return Err(self.place.wrong(place("strides"), what, "leave it out"));
            }
            if !(0.0..=MAX_STRIDES).contains(&strides) {
                let what = format!("{strides} strides are out of range");
                let remedy = "give a number from 0 to 1000";
                return Err(self.place.wrong(place("strides"), what, remedy));
            }
        }
        let heading = match motion.keys.is_empty() {
            true => None,
            false => Some(motion.motion()),
        };
        if let Some(what) = heading.as_ref().and_then(|heading| heading.defect()) {
            let remedy = "give keys with rising times and finite numbers";
            return Err(self.place.wrong(place("keys"), what, remedy));
        }
        if motion.pivot != [0.0; 3] {
            let what = "a figure turns about itself".to_owned();
            return Err(self.place.wrong(place("pivot"), what, "leave it out"));
        }
        Ok(FigureMotion {
            strides: motion.strides,
            rate: motion.rate.unwrap_or(1.0),
            travel: motion.travel.unwrap_or(true),
            heading,
        })
    }
}
