//! Markers of the document as they lie; searches on a snapshot, taken over as one edit.
//!
//! # Decided with
//! - [`toile_marker::DocumentMarker`]: a marker with its pieces where they lie;
//! - [`crate::marker_cache::MarkerCache`]: pieces in each size;
//! - [`crate::session::Session::marker_search`], [`crate::session::Session::adopt_marker`]: the search on a
//!   copy; its result taken over as one edit;
//! - [`crate::watched_search::watched`], [`toile_marker::SearchWatcher`]: progress, stop;
//! - [`crate::nest_patterns::nest_patterns`], [`toile_interchange::read_jagua`],
//!   [`crate::study::study_rules`]: several patterns, published instances; the cost of each rule;
//! - [`crate::stored_marker::nest_marker`], [`crate::marker_file_check::judge_marker_file`]: markers stored
//!   in a pattern's file; a marker's file checked again;
//! - [`crate::markers::kept_words`], [`crate::markers::other_sizes_words`]: what does not follow the garment;
//!   for whom it is;
//! - [`toile_pattern::Marker`]: the marker in the document.
//!
//! Asked for by crate `cli`, `nest_commands.rs`, and the window, `app/marker_pane.rs`.

use crate::{Command, Event, Project, Session, SessionError, Shown, Silent};
use std::sync::Arc;
use toile_marker::{DocumentMarker, Found, MarkerPieces, SearchWatcher, Start};
use toile_nesting::Search;
use toile_pattern::{Marker, MarkerId, MarkerKeeps, Pattern, plan};

/// A search for the layout of a marker, on the document as it was when the search was asked for. It
/// may run on a thread of its own.
pub struct MarkerSearch {
    marker: Arc<Marker>,
    pieces: Arc<MarkerPieces>,
}

/// Result of a search for the layout of a marker.
pub struct FoundMarker {
    marker: Arc<Marker>,
    pieces: Arc<MarkerPieces>,
    /// Placements of the pieces, and a summary of the marker.
    pub found: Found,
}

impl MarkerSearch {
    /// Lays the pieces in little length; locked pieces stay where they are. A search that is stopped
    /// early ends with the best layout so far.
    ///
    /// # Errors
    /// Pieces that cannot be laid, in words; [`SessionError::Cancelled`] if it was stopped before
    /// anything was found.
    pub fn run(
        &self,
        how: (Start, Search),
        follow: &mut SearchWatcher<'_>,
    ) -> Result<FoundMarker, SessionError> {
        Ok(FoundMarker {
            marker: self.marker.clone(),
            pieces: self.pieces.clone(),
            found: self.laid().search(how, follow)?,
        })
    }

    /// The marker as it lay when the search was asked for.
    pub fn laid(&self) -> DocumentMarker {
        DocumentMarker::new(self.marker.clone(), self.pieces.clone())
    }
}

impl Session {
    /// A marker of the document with its pieces where they lie now, also while a gesture is shown.
    ///
    /// # Errors
    /// The marker or its fabric does not exist; no piece is cut from the fabric; a piece cannot be cut.
    pub fn marker(&mut self, id: MarkerId) -> Result<DocumentMarker, SessionError> {
        self.marker_on_roll(id, 0)
    }

    /// A marker of the document with its pieces as they lie on one of its rolls, counted from 0.
    ///
    /// # Errors
    /// As [`Session::marker`].
    pub fn marker_on_roll(
        &mut self,
        id: MarkerId,
        roll: usize,
    ) -> Result<DocumentMarker, SessionError> {
        let marker = self.document_marker(id)?;
        let pieces = self.derived.markers.pieces(&self.project, &marker)?;
        Ok(DocumentMarker::on_roll(marker, pieces, roll))
    }

    /// A search for a marker of the document, to be run elsewhere and taken over by
    /// [`Session::adopt_marker`].
    ///
    /// # Errors
    /// As [`Session::marker`], and faults of the pattern in a size of the order.
    pub fn marker_search(&mut self, id: MarkerId) -> Result<MarkerSearch, SessionError> {
        let marker = self.document_marker(id)?;
        let kept = &mut self.derived.markers;
        kept.refuse_faults(&self.project, &marker)?;
        let pieces = kept.pieces(&self.project, &marker)?;
        Ok(MarkerSearch { marker, pieces })
    }

    /// Adopts the result of a search as one step of the history and one command of the journal. If the marker
    /// or its pieces have changed since the search began, the result is discarded, and `None` is returned.
    ///
    /// # Errors
    /// The edits cannot be made.
    pub fn adopt_marker(&mut self, found: FoundMarker) -> Result<Option<Vec<Event>>, SessionError> {
        let id = found.marker.id;
        let now = self.project.pattern.marker(id);
        let is_same = now.is_some_and(|now| **now == *found.marker);
        if self.gesture.is_some() || !is_same {
            return Ok(None);
        }
        let pieces = self.derived.markers.pieces(&self.project, &found.marker)?;
        if !Arc::ptr_eq(&pieces, &found.pieces) && !pieces.is_same(&found.pieces) {
            return Ok(None);
        }
        let edits = plan::place_marker(&self.evaluation(), id, found.found.placements)?;
        let label = "Lay marker".to_owned();
        let mut events = self.execute(Command::Edit { edits, label }, &mut Silent)?;
        events.extend(found.found.summaries.into_iter().map(Event::Nested));
        Ok(Some(events))
    }

    /// Notes on markers that keep their fabric or width although the garment is cut from another.
    pub(crate) fn kept_by_markers(&self) -> Vec<String> {
        let markers = self.project.pattern.markers.iter();
        markers.filter_map(|marker| self.kept_by(marker)).collect()
    }

    /// Note on a marker that keeps its fabric or width although the garment is cut from another.
    pub(crate) fn kept_by(&self, marker: &Marker) -> Option<String> {
        let pattern = &self.project.pattern;
        let keeps = pattern.marker_keeps(marker, &self.project.garment_cloth())?;
        let words = kept_words(pattern, &keeps);
        Some(format!("marker {:?} {words}", marker.name))
    }

    fn document_marker(&self, id: MarkerId) -> Result<Arc<Marker>, SessionError> {
        let pattern = &self.project.pattern;
        let names = || pattern.markers.iter().map(|marker| marker.name.clone());
        pattern
            .marker(id)
            .cloned()
            .ok_or_else(|| SessionError::Unknown {
                kind: "marker",
                name: id.to_string(),
                hint: there_are(names().collect()),
            })
    }
}

/// Note on a marker that cuts only named sizes while the garment is drafted to a wearer, or that cuts the
/// wearer's size while the garment is drafted to a named size. The words continue after the marker's name.
pub fn other_sizes_words(project: &Project, marker: &Marker) -> Option<String> {
    let pattern = &project.pattern;
    let cuts_wearers = marker.order.iter().any(|ordered| ordered.size.is_none());
    match project.size_name() {
        _ if pattern.sizes.is_empty() => return None,
        Some(size) if cuts_wearers => {
            return Some(format!(
                "cuts the wearer's, and the garment is drafted to size {size}"
            ));
        }
        None if !cuts_wearers => {}
        _ => return None,
    }
    let is_ordered = |id| marker.quantity(Some(id)) > 0;
    let sizes = pattern.sizes.iter().filter(|size| is_ordered(size.id));
    let names: Vec<&str> = sizes.map(|size| &*size.name).collect();
    let sizes = match names[..] {
        [] => return None,
        [only] => format!("size {only}"),
        _ => format!("sizes {}", names.join(", ")),
    };
    Some(format!(
        "is of {sizes}, and the garment is {}",
        project.whose()
    ))
}

/// Words for the fabric or width that a marker keeps; they continue a sentence after the marker's name.
pub fn kept_words(pattern: &Pattern, keeps: &MarkerKeeps) -> String {
    let shown = |metres: f64| Shown(pattern.unit).length(metres);
    match keeps {
        MarkerKeeps::Fabric { own, garments } => {
            format!("stays on {own}, and the garment is cut from {garments}")
        }
        MarkerKeeps::Width { own, garments } => format!(
            "stays {} wide, and the cloth of the garment is {} wide",
            shown(*own),
            shown(*garments)
        ),
    }
}

/// Markers to choose from, in words.
pub(crate) fn there_are(names: Vec<String>) -> String {
    match names.is_empty() {
        true => "the pattern has no markers: make one in the window".to_owned(),
        false => format!("choose one of {}", names.join(", ")),
    }
}
