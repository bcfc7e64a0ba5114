//! A cache of the drafts and pieces of the document's markers.

use crate::{Project, SessionError};
use std::collections::HashMap;
use std::sync::Arc;
use toile_marker::MarkerPieces;
use toile_pattern::{Draft, Evaluation, Marker, MarkerId, Pattern, Size, SizeId, Wearer};

/// The pattern in one size.
#[derive(Clone)]
struct SizeDraft {
    evaluation: Arc<Evaluation>,
    /// Pattern and wearer that the evaluation was last updated to.
    of: (Arc<Pattern>, Wearer),
    draft: Arc<Draft>,
}

/// The pieces of a marker, with the drafts and sizes they were made from.
#[derive(Clone)]
struct CachedPieces {
    drafts: Vec<Arc<Draft>>,
    sizes: Vec<Arc<Size>>,
    pieces: Arc<MarkerPieces>,
}

/// Drafts and pieces of markers; each entry is valid while its sources are the same.
#[derive(Clone, Default)]
pub(crate) struct MarkerCache {
    drafts: HashMap<Option<SizeId>, SizeDraft>,
    pieces: HashMap<MarkerId, CachedPieces>,
}

impl MarkerCache {
    /// Drafts the pattern to a size; `None`: as the project is drafted. The earlier draft is kept if the new
    /// one is equal.
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
        let garment = project.garment_cloth();
        let whose = project.whose();
        if let Some(kept) = self.pieces.get(&marker.id)
            && kept.pieces.serve((pattern, &garment), (marker, &whose))
            && all_same(kept.drafts.iter(), drafts.iter().map(|(_, draft)| draft))
            && all_same(kept.sizes.iter(), named.iter())
        {
            return Ok(kept.pieces.clone());
        }
        let pieces = Arc::new(MarkerPieces::new(
            (pattern, &garment),
            marker,
            (&drafts, &whose),
        )?);
        let kept = CachedPieces {
            drafts: drafts.into_iter().map(|(_, draft)| draft).collect(),
            sizes: named,
            pieces: pieces.clone(),
        };
        self.pieces.retain(|id, _| pattern.marker(*id).is_some());
        self.pieces.insert(marker.id, kept);
        Ok(pieces)
    }

    /// Refuses a marker if faults keep a size of its order from being made.
    pub fn refuse_faults(
        &mut self,
        project: &Project,
        marker: &Marker,
    ) -> Result<(), SessionError> {
        for one in &marker.order {
            let found = self.draft(project, one.size).evaluation.check();
            let sizes = &project.pattern.sizes;
            let size = sizes.iter().find(|size| Some(size.id) == one.size);
            let name = size.map(|size| &*size.name);
            project.refuse_faults_in(name.or(project.size_name()), &found)?;
        }
        Ok(())
    }
}

/// Whether two lists hold the same shared parts.
fn all_same<'a, T: 'a>(
    a: impl ExactSizeIterator<Item = &'a Arc<T>>,
    b: impl ExactSizeIterator<Item = &'a Arc<T>>,
) -> bool {
    a.len() == b.len() && a.zip(b).all(|(a, b)| Arc::ptr_eq(a, b))
}

/// Whether two patterns are equal apart from their markers.
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
