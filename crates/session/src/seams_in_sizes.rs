//! The seams of a pattern in its sizes: lengths, ease against that of the base size, and notches, in millimetres.

use crate::report::span_length;
use crate::sizes::selected;
use crate::{Project, SessionError};
use serde::Serialize;
use toile_pattern::walk::Walk;
use toile_pattern::{Draft, DraftSeam, Evaluation, SEAM_TOLERANCE, SizeSelection};

/// A seam in all sizes that were asked for.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SeamInSizes {
    /// Name of the seam.
    pub name: String,
    /// Whether the longer side is gathered or eased on purpose.
    pub gathered: bool,
    /// The seam in each size, in the order of their table; sizes that cannot be drafted are left out.
    pub sizes: Vec<SizedSeam>,
}

/// A seam in one size.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SizedSeam {
    /// Name of the size; `None` for a pattern without sizes.
    pub size: Option<String>,
    /// Lengths of both sides (mm).
    pub lengths_mm: [f64; 2],
    /// Length of the first side beyond the second (mm).
    pub ease_mm: f64,
    /// The ease less the one in the base size (mm); `None` where the base size has no such seam.
    pub against_base_mm: Option<f64>,
    /// Length by which one side may be longer than the other (mm); `None` for any, in gathered seams.
    pub allowed_mm: Option<f64>,
    /// Whether the sides differ by no more than that.
    pub within: bool,
    /// The notches of both sides along the seam.
    pub notches: Vec<SeamNotch>,
}

/// A notch on a side of a seam.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SeamNotch {
    /// Name of the notch.
    pub name: String,
    /// Name of the piece that it is on.
    pub piece: String,
    /// Side of the seam: 0 or 1.
    pub side: usize,
    /// Distance along the other side from the place opposite to the partner (mm). `None`: it has no partner.
    pub apart_mm: Option<f64>,
    /// Whether it meets its partner when the seam is sewn.
    pub meets: bool,
}

impl SeamInSizes {
    /// Whether the seam is within its ease in all sizes.
    pub fn is_within(&self) -> bool {
        self.sizes.iter().all(|sized| sized.within)
    }

    /// The seam in words if its ease changes from the base size to another by more than a stitch, or a notch has a
    /// partner that it meets in some sizes alone.
    pub fn uneven(&self) -> Option<String> {
        let changes = |sized: &SizedSeam| {
            sized
                .against_base_mm
                .is_some_and(|by| by.abs() > SEAM_TOLERANCE * 1e3)
        };
        let mut words: Vec<String> = Vec::new();
        if !self.gathered && self.sizes.iter().any(changes) {
            let eases = self.sizes.iter().map(|sized| {
                let size = sized.size.as_deref().unwrap_or_default();
                format!("{size} {:.1}", sized.ease_mm)
            });
            let eases: Vec<String> = eases.collect();
            words.push(format!("ease {} mm", eases.join(", ")));
        }
        let meeting = |sized: &SizedSeam| sized.notches.iter().filter(|notch| notch.meets).count();
        let most = self.sizes.iter().map(meeting).max().unwrap_or(0);
        let fewer = self.sizes.iter().filter(|sized| meeting(sized) < most);
        let fewer: Vec<&str> = fewer.filter_map(|sized| sized.size.as_deref()).collect();
        if !fewer.is_empty() {
            words.push(format!("notches part in {}", fewer.join(", ")));
        }
        (!words.is_empty()).then(|| format!("seam {:?}: {}", self.name, words.join("; ")))
    }
}

/// Every seam of a project's pattern in the sizes asked for, darts' seams included.
///
/// # Errors
/// A size that the pattern does not have.
pub fn seams_in_sizes(
    project: &Project,
    sizes: &SizeSelection,
) -> Result<Vec<SeamInSizes>, SessionError> {
    let pattern = &project.pattern;
    let names = selected(sizes, pattern)?;
    let mut evaluation = Evaluation::default();
    let mut draft_of = |size: Option<&str>| -> Result<(Evaluation, Draft), SessionError> {
        let sized = Project {
            size: size.map(str::to_owned),
            ..project.clone()
        };
        sized.check_size()?;
        evaluation.update(pattern, sized.drafted_to());
        let draft = evaluation.draft().0;
        Ok((evaluation.clone(), draft))
    };
    let base = pattern.base().map(|size| size.name.clone());
    let (_, base) = draft_of(base.as_deref())?;
    let ease = |draft: &Draft, seam: &DraftSeam| {
        let [first, second] = lengths(draft, seam);
        first - second
    };
    let mut found: Vec<(toile_pattern::SeamOrigin, SeamInSizes)> = Vec::new();
    for (size, _) in names {
        let (evaluation, draft) = draft_of(size.as_deref())?;
        for seam in &draft.seams {
            let known = base.seams.iter().find(|known| known.id == seam.id);
            let allowed = evaluation.ease(seam.id).max(0.0);
            let own = ease(&draft, seam);
            let sized = SizedSeam {
                size: size.clone(),
                lengths_mm: lengths(&draft, seam).map(|length| length * 1e3),
                ease_mm: own * 1e3,
                against_base_mm: known.map(|known| (own - ease(&base, known)) * 1e3),
                allowed_mm: (!seam.gathered).then_some(allowed * 1e3),
                within: seam.gathered || own.abs() <= allowed + SEAM_TOLERANCE,
                notches: notches((&evaluation, &draft), seam),
            };
            match found.iter_mut().find(|(id, _)| *id == seam.id) {
                Some((_, known)) => known.sizes.push(sized),
                None => found.push((
                    seam.id,
                    SeamInSizes {
                        name: seam.name.clone(),
                        gathered: seam.gathered,
                        sizes: vec![sized],
                    },
                )),
            }
        }
    }
    Ok(found.into_iter().map(|(_, seam)| seam).collect())
}

/// Lengths of both sides of a seam (m).
fn lengths(draft: &Draft, seam: &DraftSeam) -> [f64; 2] {
    [0, 1].map(|side| {
        let spans = seam.sides[side].iter();
        spans.map(|span| span_length(draft, span)).sum()
    })
}

fn notches((evaluation, draft): (&Evaluation, &Draft), seam: &DraftSeam) -> Vec<SeamNotch> {
    let pattern = evaluation.pattern();
    let Some(walk) = Walk::new(draft, seam) else {
        return Vec::new();
    };
    let of = |notch: toile_pattern::walk::WalkedNotch| {
        let panels = pattern.panels.iter();
        let named = panels.flat_map(|panel| &panel.notches);
        let mut named = named.filter(|known| known.id == notch.id);
        SeamNotch {
            name: named
                .next()
                .map_or_else(String::new, |known| known.name.clone()),
            piece: draft.pieces[notch.piece].name.clone(),
            side: notch.side,
            apart_mm: notch.partner.map(|apart| apart * 1e3),
            meets: notch.meets(),
        }
    };
    walk.notches().into_iter().map(of).collect()
}
