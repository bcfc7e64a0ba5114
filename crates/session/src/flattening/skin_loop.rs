//! A loop that is laid on a skin place by place, and the region inside it flattened.

use super::flat_surface::FlatSurface;
use super::report::FlattenOptions;
use crate::SessionError;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use toile_body::Mannequin;
use toile_flatten::{LoopError, MAX_PLACES, MIN_PLACES, surface_path};
use toile_geometry::{TriangleMesh, Vec3, ray_into_triangle};
use toile_pattern::Fabric;

/// Distance from the middle plane of the body within which a place is laid on the plane (m).
const SNAP: f64 = 0.008;

/// Distance by which skin must be nearer than a place to hide it (m).
const HIDDEN: f64 = 0.005;

/// A loop of places on the skin of a mannequin, joined by shortest paths.
#[derive(Clone)]
pub struct SkinLoop {
    mannequin: Arc<Mannequin>,
    places: Vec<Vec3>,
    /// The shortest path to each place from the one before it (m); empty for the first.
    paths: Vec<Vec<Vec3>>,
    /// The path from the last place to the first (m); empty while there are too few places.
    closing: Vec<Vec3>,
}

impl SkinLoop {
    /// A loop without places on a mannequin, which stands with its middle in the plane x = 0.
    pub fn new(mannequin: Arc<Mannequin>) -> Self {
        Self {
            mannequin,
            places: Vec::new(),
            paths: Vec::new(),
            closing: Vec::new(),
        }
    }

    /// Whether the loop is laid on a skin.
    pub fn is_on(&self, skin: &TriangleMesh) -> bool {
        self.mannequin.skin() == skin
    }

    /// Adds the place where a ray first meets the skin, on the middle plane if it is near that.
    ///
    /// # Errors
    /// The ray misses the skin, there are too many places, or the place is the one before it: in words, with the remedy.
    pub fn add(&mut self, origin: Vec3, direction: Vec3) -> Result<(), String> {
        let mut place = self.met(origin, direction).ok_or_else(|| {
            "the mannequin is not there; click a place on it, or Leave to end the loop".to_owned()
        })?;
        if place.x.abs() < SNAP {
            place.x = 0.0;
        }
        if self.places.len() == MAX_PLACES {
            return Err(format!(
                "a loop has at most {MAX_PLACES} places; make the panel, or take places back"
            ));
        }
        let path = match self.places.last() {
            Some(&before) => self.path(before, place)?,
            None => Vec::new(),
        };
        self.paths.push(path);
        self.places.push(place);
        self.close();
        Ok(())
    }

    /// Takes the last place back.
    pub fn take_back(&mut self) {
        self.places.pop();
        self.paths.pop();
        self.close();
    }

    fn close(&mut self) {
        let closed = match self.places[..] {
            [first, .., last] if self.is_whole() => self.path(last, first),
            _ => Ok(Vec::new()),
        };
        self.closing = closed.unwrap_or_default();
    }

    fn path(&self, from: Vec3, to: Vec3) -> Result<Vec<Vec3>, String> {
        surface_path(self.mannequin.skin_tree(), [from, to]).map_err(|error| {
            let is_same = matches!(error, LoopError::Same(..));
            match is_same {
                true => "this is the place before; click another".to_owned(),
                false => error.to_string(),
            }
        })
    }

    /// The first place where a ray enters the skin (m).
    fn met(&self, origin: Vec3, direction: Vec3) -> Option<Vec3> {
        let skin = self.mannequin.skin();
        let corners = |t: &[u32; 3]| t.map(|v| skin.positions[v as usize]);
        let triangles = skin.triangles.iter();
        let hits = triangles.filter_map(|t| ray_into_triangle(origin, direction, corners(t)));
        let nearest = hits.min_by(f64::total_cmp)?;
        Some(origin + direction * nearest)
    }

    /// The places, in order (m).
    pub fn places(&self) -> &[Vec3] {
        &self.places
    }

    /// Whether a place is seen from an eye: whether no other part of the skin hides it.
    pub fn is_seen(&self, place: Vec3, eye: Vec3) -> bool {
        let way = place - eye;
        let nearest = self.met(eye, way);
        nearest.is_none_or(|met| (met - eye).norm() > way.norm() - HIDDEN)
    }

    /// Whether there are places enough round a region.
    pub fn is_whole(&self) -> bool {
        self.places.len() >= MIN_PLACES
    }

    /// The paths from place to place (m).
    pub fn paths(&self) -> &[Vec<Vec3>] {
        &self.paths
    }

    /// The path that closes the loop (m); empty while there are too few places.
    pub fn closing(&self) -> &[Vec3] {
        &self.closing
    }

    /// Flattens the region inside to a panel of a fabric; that of the options is not read. It ends soon after `stop` is set.
    ///
    /// # Errors
    /// The region is no disk, a number cannot be used, or it was stopped.
    pub fn flatten(
        &self,
        fabric: Fabric,
        (name, options): (&str, &FlattenOptions),
        stop: Option<Arc<AtomicBool>>,
    ) -> Result<FlatSurface, SessionError> {
        let loop_on = (self.mannequin.skin(), &*self.places);
        FlatSurface::of_skin(loop_on, fabric, (name, options), stop)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use toile_body::Figure;
    use toile_pattern::{Ids, Severity};

    fn woman() -> Arc<Mannequin> {
        let figure = Figure::Woman;
        Arc::new(Mannequin::new(&figure.average(), figure).unwrap())
    }

    /// A ray from the front, at a place across and up (m).
    fn front(x: f64, y: f64) -> [Vec3; 2] {
        [Vec3::new(x, y, 3.0), -Vec3::z()]
    }

    #[test]
    fn a_loop_on_the_front_of_a_woman_is_a_panel() {
        let mut laid = SkinLoop::new(woman());
        for [x, y] in [[0.0, 1.05], [0.09, 1.06], [0.09, 1.13], [0.003, 1.13]] {
            let [origin, direction] = front(x, y);
            laid.add(origin, direction).unwrap();
        }
        assert!(laid.is_whole() && laid.closing().len() > 1);
        assert!(laid.places().iter().all(|place| place.z > 0.0));
        // Near the middle it lies in the middle.
        assert_eq!(laid.places()[3].x, 0.0);
        assert!(laid.paths()[0].is_empty() && laid.paths()[1].len() > 2);
        let mut ids = Ids::default();
        let fabric = Fabric::poplin(ids.take());
        let options = FlattenOptions {
            strain: 0.02,
            ease: 0.01,
            ..FlattenOptions::default()
        };
        let stopped = Some(Arc::new(AtomicBool::new(true)));
        let made = laid.flatten(fabric.clone(), ("front", &options), stopped);
        assert!(matches!(made, Err(SessionError::Cancelled)));
        let flat = laid.flatten(fabric, ("front", &options), None).unwrap();
        let area = flat.report.panel_area_m2;
        assert!((0.005..0.01).contains(&area), "{area}");
        // Each triangle has the colour of its own stretch.
        for (colour, stretch) in flat.colours().into_iter().zip(flat.stretch()) {
            let size = stretch.map(f64::abs).into_iter().fold(0.0, f64::max);
            assert_eq!(colour, FlatSurface::colour_of(size, 0.02));
        }
        laid.take_back();
        laid.take_back();
        assert!(!laid.is_whole() && laid.closing().is_empty());
    }

    #[test]
    fn panels_of_clicked_regions_can_be_made() {
        let woman = woman();
        let mut ids = Ids::default();
        let fabric = Fabric::poplin(ids.take());
        // Fronts of a bodice, with the breast inside, as one clicks them: from the middle of the waist round.
        let bodice = [
            [0.0, 0.88],
            [0.13, 0.90],
            [0.12, 1.2],
            [0.1, 1.32],
            [0.07, 1.34],
            [0.0, 1.28],
        ];
        let upper = [
            [0.0, 1.02],
            [0.12, 1.04],
            [0.13, 1.2],
            [0.06, 1.34],
            [0.0, 1.26],
        ];
        for (places, darts) in [(&bodice[..], 2), (&bodice, 3), (&upper, 2), (&upper, 4)] {
            let mut laid = SkinLoop::new(woman.clone());
            for &[x, y] in places {
                let [origin, direction] = front(x, y);
                laid.add(origin, direction).unwrap();
            }
            let options = FlattenOptions {
                strain: 0.02,
                ease: 0.01,
                darts,
                ..FlattenOptions::default()
            };
            let flat = laid
                .flatten(fabric.clone(), ("front", &options), None)
                .unwrap();
            let faults = flat.pattern.check(&toile_measure::Measurements::adult());
            let error = faults
                .iter()
                .find(|found| found.severity == Severity::Error);
            assert_eq!(error, None, "{darts} darts");
            assert!(!flat.report.darts.is_empty());
        }
    }

    #[test]
    fn clicks_beside_the_skin_and_twice_on_one_place_are_refused() {
        let mut laid = SkinLoop::new(woman());
        let [origin, direction] = front(2.0, 1.0);
        let fault = laid.add(origin, direction).unwrap_err();
        assert!(fault.contains("not there"), "{fault}");
        let [origin, direction] = front(0.0, 1.1);
        laid.add(origin, direction).unwrap();
        let fault = laid.add(origin, direction).unwrap_err();
        assert!(
            fault.contains("place before") && laid.places().len() == 1,
            "{fault}"
        );
    }
}
