//! Markers of the document, kept up to date with it; searches on a snapshot, taken over as one edit.

use crate::{Command, Event, Project, Session, SessionError, Silent};
use std::collections::HashMap;
use std::sync::Arc;
use toile_marker::{Follow, Found, LaidMarker, MarkerPieces, Start};
use toile_nesting::Search;
use toile_pattern::{Draft, Evaluation, Marker, MarkerId, Pattern, Size, SizeId, Wearer, plan};

/// The pattern in one size.
#[derive(Clone)]
struct SizeDraft {
    evaluation: Arc<Evaluation>,
    /// The pattern and wearer it was last brought up to date with.
    of: (Arc<Pattern>, Wearer),
    draft: Arc<Draft>,
}

/// The pieces of a marker, and what they were made from.
#[derive(Clone)]
struct KeptPieces {
    drafts: Vec<Arc<Draft>>,
    sizes: Vec<Arc<Size>>,
    pieces: Arc<MarkerPieces>,
}

/// Drafts and pieces of markers, kept while what they were made from stays the same.
#[derive(Clone, Default)]
pub(crate) struct KeptMarkers {
    drafts: HashMap<Option<SizeId>, SizeDraft>,
    pieces: HashMap<MarkerId, KeptPieces>,
}

impl KeptMarkers {
    /// A pattern drafted to a size. The draft before stays where the new one is the same.
    fn draft(&mut self, project: &Project, size: Option<SizeId>) -> &SizeDraft {
        let pattern = &project.pattern;
        let own = pattern.sizes.iter().find(|own| Some(own.id) == size);
        let wearer = own.map_or_else(|| project.drafted_to(), Wearer::from);
        let kept = self.drafts.entry(size).or_insert_with(|| SizeDraft {
            evaluation: Arc::default(),
            of: Default::default(),
            draft: Arc::default(),
        });
        if !drafts_alike(&kept.of.0, pattern) || kept.of.1 != wearer {
            Arc::make_mut(&mut kept.evaluation).update(pattern, &wearer);
            let (draft, _) = kept.evaluation.draft();
            if draft != *kept.draft {
                kept.draft = Arc::new(draft);
            }
        }
        kept.of = (pattern.clone(), wearer);
        kept
    }

    /// The pieces of a marker of a project's pattern.
    pub fn pieces(
        &mut self,
        project: &Project,
        marker: &Marker,
    ) -> Result<Arc<MarkerPieces>, SessionError> {
        let pattern = &project.pattern;
        let sizes: Vec<Option<SizeId>> = marker.order.iter().map(|one| one.size).collect();
        let mut drafts = Vec::new();
        for &size in &sizes {
            drafts.push((size, self.draft(project, size).draft.clone()));
        }
        let named = pattern.sizes.iter();
        let named = named.filter(|size| sizes.contains(&Some(size.id)));
        let named: Vec<Arc<Size>> = named.cloned().collect();
        if let Some(kept) = self.pieces.get(&marker.id)
            && kept.pieces.serve(marker)
            && all_same(kept.drafts.iter(), drafts.iter().map(|(_, draft)| draft))
            && all_same(kept.sizes.iter(), named.iter())
        {
            return Ok(kept.pieces.clone());
        }
        let pieces = Arc::new(MarkerPieces::new(pattern, marker, &drafts)?);
        let kept = KeptPieces {
            drafts: drafts.into_iter().map(|(_, draft)| draft).collect(),
            sizes: named,
            pieces: pieces.clone(),
        };
        self.pieces.retain(|id, _| pattern.marker(*id).is_some());
        self.pieces.insert(marker.id, kept);
        Ok(pieces)
    }

    /// Everything that keeps a size of a marker's order from being made.
    fn refuse_faults(&mut self, project: &Project, marker: &Marker) -> Result<(), SessionError> {
        for one in &marker.order {
            let found = self.draft(project, one.size).evaluation.check();
            project.refuse_faults(&found)?;
        }
        Ok(())
    }
}

/// Whether two lists hold the same parts.
fn all_same<'a, T: 'a>(
    a: impl ExactSizeIterator<Item = &'a Arc<T>>,
    b: impl ExactSizeIterator<Item = &'a Arc<T>>,
) -> bool {
    a.len() == b.len() && a.zip(b).all(|(a, b)| Arc::ptr_eq(a, b))
}

/// Whether two patterns differ in their markers at most.
fn drafts_alike(a: &Arc<Pattern>, b: &Arc<Pattern>) -> bool {
    Arc::ptr_eq(a, b)
        || (a.name == b.name
            && a.unit == b.unit
            && a.base_size == b.base_size
            && all_same(a.sizes.iter(), b.sizes.iter())
            && all_same(a.variables.iter(), b.variables.iter())
            && all_same(a.fabrics.iter(), b.fabrics.iter())
            && all_same(a.sheets.iter(), b.sheets.iter())
            && all_same(a.panels.iter(), b.panels.iter())
            && all_same(a.seams.iter(), b.seams.iter()))
}

/// A search for a marker of a document, on what the document was when it was asked for. It may run
/// on a thread of its own.
pub struct MarkerSearch {
    marker: Arc<Marker>,
    pieces: Arc<MarkerPieces>,
}

/// What such a search found.
pub struct FoundMarker {
    marker: Arc<Marker>,
    pieces: Arc<MarkerPieces>,
    /// Where the pieces lie, and the marker in a few numbers.
    pub found: Found,
}

impl MarkerSearch {
    /// Lays the pieces in little length; locked ones stay where they are. Stopped early, it ends with
    /// the best so far.
    ///
    /// # Errors
    /// Pieces that cannot be laid, in words; [`SessionError::Cancelled`] if it was stopped before
    /// anything was found.
    pub fn run(
        &self,
        how: (Start, Search),
        follow: &mut Follow<'_>,
    ) -> Result<FoundMarker, SessionError> {
        let laid = LaidMarker::new(self.marker.clone(), self.pieces.clone());
        Ok(FoundMarker {
            marker: self.marker.clone(),
            pieces: self.pieces.clone(),
            found: laid.search(how, follow)?,
        })
    }
}

impl Session {
    /// A marker of the document with its pieces where they lie now, also while a gesture is shown.
    ///
    /// # Errors
    /// The marker or its fabric is not there; nothing is cut from it; a piece cannot be cut.
    pub fn marker(&mut self, id: MarkerId) -> Result<LaidMarker, SessionError> {
        let marker = self.document_marker(id)?;
        let pieces = self.derived.markers.pieces(&self.project, &marker)?;
        Ok(LaidMarker::new(marker, pieces))
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

    /// Takes over what a search found: one step of the history, one command of the journal. Where the
    /// marker or its pieces have changed since, it comes too late and is dropped; nothing is told
    /// then.
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
        events.push(Event::Nested(found.found.nested));
        Ok(Some(events))
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

/// Markers to choose from, in words.
pub(crate) fn there_are(names: Vec<String>) -> String {
    match names.is_empty() {
        true => "the pattern has no markers: make one in the window".to_owned(),
        false => format!("choose one of {}", names.join(", ")),
    }
}
