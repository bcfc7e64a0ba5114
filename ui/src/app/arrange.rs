//! Copies, pastes, duplicates, aligns and distributes the selection; inserts other patterns.

use super::ToileApp;
use super::notice::Notice;
use crate::canvas::scene::Scene;
use crate::canvas::selection::{Item, Selection};
use crate::canvas::table_layout::TableLayout;
use crate::tools::Planning;
use std::path::Path;
use std::sync::Arc;
use toile_geometry::{Bounds2, Vec2};
use toile_pattern::plan::{self, Alignment, Axis, Fragment, PasteTarget, Pasted};
use toile_pattern::{Edit, EditError, Entity, Evaluation, PartId, Pattern, PointId};
use toile_session::Project;

/// Offset of pasted points and curves from their originals, right and down (m).
const ASIDE: f64 = 0.02;

/// Distance from the existing drawing to the origin of a new sheet (m); a piece can be drawn to the left of
/// it.
const SHEETS_APART: f64 = 0.4;

/// Gap between panels and their duplicate (m).
const BESIDE: f64 = 0.05;

impl ToileApp {
    pub(super) fn selected_parts(&self) -> Vec<PartId> {
        let items = self.view.selection.items().iter();
        items.map(|item| item.part()).collect()
    }

    /// The selected parts as text for the clipboard.
    fn copied_text(&mut self) -> Option<String> {
        let copied = plan::copy(&self.base, &self.selected_parts())
            .map_err(|error| error.to_string())
            .and_then(|fragment| {
                let fragment = self.as_laid(fragment);
                let text = serde_json::to_string(&fragment).map_err(|error| error.to_string())?;
                Ok((fragment, text))
            });
        match copied {
            Ok((fragment, text)) => {
                self.copied = Some(fragment);
                Some(text)
            }
            Err(words) => {
                self.notice = Notice::fault(words);
                None
            }
        }
    }

    /// The fragment with the positions at which its sheets are displayed on the table. The document may
    /// hold older positions, from before the sheets were laid side by side.
    fn as_laid(&self, mut fragment: Fragment) -> Fragment {
        for sheet in &mut fragment.sheets {
            let place = self.view.table_layout.sheet(sheet.id);
            Arc::make_mut(sheet).on_table = place.into();
        }
        fragment
    }

    /// Adds an empty sheet beside the existing drawing, level with the current sheet, and makes it the
    /// current one. The displayed positions of all sheets are then stored in the document.
    pub(crate) fn new_sheet(&mut self) {
        let bounds = self.view.table_layout.bounds(&self.whole_scene());
        let place = bounds.map_or_else(Vec2::zeros, |bounds| {
            Vec2::new(bounds.max.x + SHEETS_APART, self.view.sheet_origin().y)
        });
        let laid = self.view.table_layout.laid_apart(self.base.pattern());
        let planned = plan::move_sheets(&self.base, &laid).and_then(|mut edits| {
            let (added, sheet) = plan::add_sheet(&self.base, None, place.into())?;
            edits.extend(added);
            Ok((edits, sheet))
        });
        match planned {
            Ok((edits, sheet)) => {
                if self.edit(Ok(edits), "New sheet") {
                    self.show_all();
                    self.view.select(Selection::one(Item::Sheet(sheet)));
                    self.view.fit();
                }
            }
            Err(error) => self.say_fault(error.to_string()),
        }
    }

    /// The scene of everything on the table, even while some panels are isolated.
    fn whole_scene(&self) -> Scene {
        let mut scene = self.view.scene.clone();
        if !self.view.isolated.is_empty() {
            let draft = scene.draft.clone();
            scene.update(&self.base, &draft, scene.octave());
        }
        scene
    }

    /// Ends the isolation of panels: otherwise parts that are added would be hidden.
    fn show_all(&mut self) {
        if !self.view.isolated.is_empty() {
            self.view.isolated.clear();
            self.revision = None;
            self.refresh();
        }
    }

    /// Copies the selection by a menu command; the keys for it come from the system as events.
    pub(crate) fn copy(&mut self) {
        if self.copied_text().is_some() {
            self.wants_clipboard = true;
        }
    }

    pub(crate) fn cut(&mut self) {
        if self.copied_text().is_some() {
            self.wants_clipboard = true;
            self.delete();
        }
    }

    /// Pastes the parts that were copied last in this window.
    pub(crate) fn paste_copied(&mut self) {
        if let Some(fragment) = self.copied.clone() {
            self.paste(&fragment);
        }
    }

    pub(crate) fn has_copied(&self) -> bool {
        self.is_open() && self.copied.is_some()
    }

    /// Handles copy, cut and paste events of the system while no text is typed.
    pub(crate) fn take_clipboard(&mut self, context: &egui::Context) {
        self.follow_clipboard(context);
        if self.wants_clipboard {
            self.wants_clipboard = false;
            if let Some(text) = self
                .copied
                .as_ref()
                .and_then(|f| serde_json::to_string(f).ok())
            {
                context.copy_text(text);
            }
        }
    }

    fn follow_clipboard(&mut self, context: &egui::Context) {
        if !self.is_open() || self.dialog.is_some() || self.types(context) {
            return;
        }
        let asked: Vec<egui::Event> = context.input(|input| {
            let wanted = |event: &&egui::Event| {
                matches!(
                    event,
                    egui::Event::Copy | egui::Event::Cut | egui::Event::Paste(_)
                )
            };
            input.events.iter().filter(wanted).cloned().collect()
        });
        for event in asked {
            match event {
                egui::Event::Copy if self.has_selection() => self.copy(),
                egui::Event::Cut if self.has_selection() => self.cut(),
                egui::Event::Paste(text) => match serde_json::from_str::<Fragment>(&text) {
                    Ok(fragment) => self.paste(&fragment),
                    Err(_) => {
                        self.notice = Notice::fault(
                            "the clipboard holds no parts of a pattern: copy panels or points first",
                        );
                    }
                },
                _ => {}
            }
        }
    }

    fn paste(&mut self, fragment: &Fragment) {
        // Panels bring sheets of their own; points and curves go to the current sheet, unless their sheet
        // was copied.
        let is_bare = fragment.panels.is_empty() && fragment.whole_sheets.is_empty();
        let loose = is_bare && fragment.sheets.len() <= 1;
        let target = PasteTarget {
            sheet: self.view.sheet.filter(|_| loose),
            offset: [ASIDE, -ASIDE],
        };
        let pasted = match is_bare {
            true => plan::paste(&self.base, fragment, target),
            false => self.pasted_free(fragment),
        };
        self.take_pasted(pasted, "Paste");
    }

    /// Pastes panels and sheets at their original places; if these are occupied, in free room to the right
    /// of them.
    fn pasted_free(&self, fragment: &Fragment) -> Result<Pasted, EditError> {
        let aside = |aside: f64| {
            let target = PasteTarget {
                sheet: None,
                offset: [aside, 0.0],
            };
            plan::paste(&self.base, fragment, target)
        };
        let there = aside(0.0)?;
        let scene = self.whole_scene();
        let mut trial = Planning::of(&self.base);
        trial.make(there.edits.clone())?;
        let (mut with, mut table_layout) = (scene.clone(), self.view.table_layout.clone());
        with.update(trial.evaluation(), &Arc::default(), scene.octave());
        table_layout.follow(trial.evaluation().pattern());
        let copies = on_table((&with, &table_layout), |id| there.parts.contains(&id));
        let others = on_table((&scene, &self.view.table_layout), |_| true);
        let is_free = |copy: &Bounds2| !others.iter().any(|other| touch(copy, other));
        if copies.iter().all(is_free) {
            return Ok(there);
        }
        let bounds = copies.into_iter().reduce(|a, b| a.union(&b));
        aside(bounds.map_or(0.0, |bounds| self.free_aside(&scene, &bounds)))
    }

    pub(crate) fn duplicate(&mut self) {
        let parts = self.selected_parts();
        let is_whole = |part: &PartId| matches!(part, PartId::Panel(_) | PartId::Sheet(_));
        let pasted = match parts.iter().all(is_whole) {
            // The copies go beside the panels and their mirrored halves, as these are displayed.
            true => plan::copy(&self.base, &parts).and_then(|fragment| {
                let scene = self.whole_scene();
                let bounds = on_table((&scene, &self.view.table_layout), |id| parts.contains(&id));
                let bounds = bounds.into_iter().reduce(|a, b| a.union(&b));
                let aside = bounds.map_or(0.0, |bounds| self.free_aside(&scene, &bounds));
                let target = PasteTarget {
                    sheet: None,
                    offset: [aside, 0.0],
                };
                plan::paste(&self.base, &self.as_laid(fragment), target)
            }),
            false => plan::duplicate(&self.base, &parts),
        };
        self.take_pasted(pasted, "Duplicate");
    }

    /// Distance to the right (m) by which the rectangle `bounds` must be moved to overlap no panel and no
    /// sheet.
    fn free_aside(&self, scene: &Scene, bounds: &Bounds2) -> f64 {
        let mut panels = on_table((scene, &self.view.table_layout), |_| true);
        panels.sort_by(|a, b| a.min.x.total_cmp(&b.min.x));
        let mut aside = bounds.size().x + BESIDE;
        for panel in panels {
            let is_beside = panel.min.y <= bounds.max.y && bounds.min.y <= panel.max.y;
            let is_under = panel.min.x < bounds.max.x + aside + BESIDE
                && bounds.min.x + aside < panel.max.x + BESIDE;
            // A panel that only touches the place tried so far moves it to the right, too.
            if is_beside && is_under && panel.max.x > bounds.max.x {
                aside = panel.max.x + BESIDE - bounds.min.x;
            }
        }
        aside
    }

    /// Adds the pasted parts to the pattern, selects them, and reports which numbers lost their formulas.
    pub(super) fn take_pasted(&mut self, pasted: Result<Pasted, EditError>, label: &str) {
        let pasted = match pasted {
            Ok(pasted) => pasted,
            Err(error) => {
                self.notice = Notice::fault(error.to_string());
                return;
            }
        };
        // A pasted sheet stores its position in the document; then all other sheets must store theirs, too.
        let brings_sheets = pasted
            .edits
            .iter()
            .any(|edit| matches!(edit, Edit::Put(Entity::Sheet(_))));
        let laid = match brings_sheets {
            true => self.view.table_layout.laid_apart(self.base.pattern()),
            false => Vec::new(),
        };
        let edits = plan::move_sheets(&self.base, &laid).map(|mut edits| {
            edits.extend(pasted.edits);
            edits
        });
        if !self.edit(edits, label) {
            return;
        }
        if brings_sheets {
            self.show_all();
        }
        let selection = select_pasted(self.base.pattern(), &pasted.parts);
        self.view.select(selection);
        if brings_sheets {
            let copies = on_table((&self.view.scene, &self.view.table_layout), |id| {
                pasted.parts.contains(&id)
            });
            let room = copies.into_iter().reduce(|a, b| a.union(&b));
            room.into_iter()
                .for_each(|room| self.view.reveal_room(room));
        }
        if !pasted.loosened.is_empty() {
            self.notice = Notice::warning(format!(
                "{} spoke of parts that are not here, and are values now",
                count(pasted.loosened.len(), "number")
            ));
        }
    }

    /// Inserts the panels of another pattern beside the existing ones.
    pub(crate) fn insert_file(&mut self, path: &Path) {
        let other = match Project::open(path) {
            Ok((other, _)) => other,
            Err(error) => {
                self.notice = Notice::fault(error.to_string());
                return;
            }
        };
        let evaluation = Evaluation::new(&other.pattern, other.drafted_to());
        let pasted = plan::insert_pattern(&self.base, &evaluation, self.place_beside());
        self.take_pasted(pasted, "Insert pattern");
        self.view.fit();
    }

    /// A place beside all there is on the table (m).
    pub(super) fn place_beside(&self) -> [f64; 2] {
        let right = self.view.table_layout.bounds(&self.whole_scene());
        let beside = right.map_or(Vec2::zeros(), |bounds| {
            Vec2::new(bounds.max.x + 0.1, bounds.min.y)
        });
        beside.into()
    }

    /// Groups of points that move together: one group for each selected part.
    fn groups(&self) -> Vec<Vec<PointId>> {
        let parts = self.selected_parts();
        let groups = parts
            .iter()
            .map(|part| plan::points_of(&self.base, &[*part]));
        groups.filter(|group| !group.is_empty()).collect()
    }

    pub(crate) fn has_several(&self) -> bool {
        self.view.selection.items().len() > 1
    }

    pub(crate) fn align(&mut self, alignment: Alignment) {
        let moved = plan::align(&self.base, &self.groups(), alignment);
        self.take_moved(moved, "Align");
    }

    pub(crate) fn distribute(&mut self, axis: Axis) {
        let moved = plan::distribute(&self.base, &self.groups(), axis);
        self.take_moved(moved, "Distribute");
    }

    fn take_moved(&mut self, moved: Result<plan::Moved, EditError>, label: &str) {
        match moved {
            Ok(moved) => {
                let stayed = moved.held.len();
                if self.edit(Ok(moved.edits), label) && stayed > 0 {
                    self.notice = Notice::warning(format!(
                        "{} did not move: formulas or other points place them",
                        count(stayed, "point")
                    ));
                }
            }
            Err(error) => self.notice = Notice::fault(error.to_string()),
        }
    }
}

/// Bounding rectangles on the table (m): of panels that are `wanted` or whose sheet is, and of `wanted`
/// sheets without panels.
fn on_table(
    (scene, table_layout): (&Scene, &TableLayout),
    wanted: impl Fn(PartId) -> bool,
) -> Vec<Bounds2> {
    let moved = |bounds: Bounds2, place: Vec2| Bounds2 {
        min: bounds.min + place,
        max: bounds.max + place,
    };
    let panels = scene.panels.iter();
    let panels = panels.filter(|panel| wanted(panel.id.into()) || wanted(panel.sheet.into()));
    let panels = panels.map(|panel| moved(*panel.bounds(), table_layout.panel(panel.id)));
    let sheets = scene.sheets.iter();
    let bare = sheets.filter(|sheet| sheet.is_bare && wanted(sheet.id.into()));
    let bare = bare.map(|sheet| {
        let bounds = sheet.bounds();
        let bounds = bounds.unwrap_or_else(|| Bounds2::of([Vec2::zeros()]));
        moved(bounds, table_layout.sheet(sheet.id))
    });
    panels.chain(bare).collect()
}

/// Whether two rectangles overlap or touch.
fn touch(a: &Bounds2, b: &Bounds2) -> bool {
    (0..2).all(|k| a.min[k] <= b.max[k] && b.min[k] <= a.max[k])
}

/// Selection after a paste: the new panels; if there are none, the new sheets; else the new curves and
/// points.
fn select_pasted(pattern: &Pattern, parts: &[PartId]) -> Selection {
    let panels: Selection = parts
        .iter()
        .filter_map(|part| match part {
            PartId::Panel(id) => Some(Item::Panel(*id)),
            _ => None,
        })
        .collect();
    if !panels.is_empty() {
        return panels;
    }
    let sheets: Selection = parts
        .iter()
        .filter_map(|part| match part {
            PartId::Sheet(id) => Some(Item::Sheet(*id)),
            _ => None,
        })
        .collect();
    if !sheets.is_empty() {
        return sheets;
    }
    let items = parts.iter().filter_map(|part| match part {
        PartId::Point(id) => Some(Item::Point(*id)),
        PartId::Curve(id) => Some(Item::Curve(*id)),
        _ => None,
    });
    items.filter(|item| item.words(pattern).is_some()).collect()
}

/// A count with its noun, as "1 point" or "3 points".
pub(super) fn count(number: usize, thing: &str) -> String {
    match number {
        1 => format!("1 {thing}"),
        _ => format!("{number} {thing}s"),
    }
}
