//! The pane with the marker: its order and fabric, the search for a short one, and the edits made in its
//! view.
//!
//! # Decided with
//! - [`crate::app::ToileApp::cloth_fields`] (`marker_cloth.rs`), [`crate::app::ToileApp::laying_rows`]
//!   (`marker_laying.rs`), [`crate::app::ToileApp::rule_fields`] (`marker_rules.rs`): fields: the fabric, how
//!   it is laid, rules of pieces;
//! - [`crate::app::ToileApp::mend_button`] (`marker_cloth.rs`), [`toile_session::kept_words`]: what does not
//!   follow the garment;
//! - [`toile_session::Session::marker_search`] (`markers.rs`): the search;
//! - [`crate::app::ToileApp::drop_pieces`] (`marker_drop.rs`): pieces let go;
//! - [`crate::views::marker::MarkerView`], [`crate::views`] (`marker_paint.rs`): the view of it;
//! - [`toile_pattern::plan::place_pieces`], [`toile_pattern::plan::set_marker_cloth`]: the edits it gives.
//!
//! By hand: a new setting of the fabric needs a field here.

use super::ToileApp;
use super::job::Job;
use super::marker_cloth::kept_label;
use super::notice::Notice;
use super::tool_commands::{
    LOCK_PIECE, NEW_MARKER, REMOVE_MARKER, SEARCH_MARKER, STOP_SEARCH, TAKE_OFF, TURN_OVER,
    TURN_PIECE,
};
use crate::fields::Entered;
use crate::theme::Palette;
use crate::tools::number;
use crate::views::marker::{MarkerAction, MarkerView};
use egui::{ComboBox, DragValue, RichText, Ui};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;
use toile_pattern::plan;
use toile_pattern::{Edit, EditError, Marker, MarkerId, OrderedSize, SizeId, Want};
use toile_session::{
    DocumentMarker, FoundMarker, Search, SearchWatcher, SessionError, Start, Watcher,
};

/// Width of the field for the name of the marker (pixels).
const NAME_WIDTH: f32 = 110.0;
/// Choices for the time of a search (s).
const SECONDS: [f64; 4] = [2.0, 10.0, 60.0, 300.0];
/// A search counts as ended early if it took at most this share of the time it was given (1).
const EARLY: f64 = 0.8;

/// A search in progress.
pub struct Searching {
    job: Job<FoundMarker>,
    /// Newest marker that the search has found; `None` once it is shown.
    newest: Arc<Mutex<Option<DocumentMarker>>>,
    /// Moment at which the search began.
    began: Instant,
    /// Time that the search was given (s).
    seconds: f64,
    /// Whether the user stopped the search.
    is_stopped: bool,
}

impl Searching {
    /// Reason why the search ended clearly before its time was up; `None` if it did not.
    fn ended_early(&self) -> Option<String> {
        let took = self.began.elapsed().as_secs_f64();
        if took > EARLY * self.seconds {
            return None;
        }
        Some(match self.is_stopped {
            true => format!("stopped after {took:.1} s: the best so far"),
            false => format!(
                "ended after {took:.1} of {:.0} s: no shorter marker is possible, or nothing was left to try",
                self.seconds
            ),
        })
    }
}

/// Settings of a search.
#[derive(Clone, Copy, Debug)]
pub struct SearchChoice {
    seconds: f64,
}

impl Default for SearchChoice {
    fn default() -> Self {
        Self {
            seconds: SECONDS[1],
        }
    }
}

impl ToileApp {
    /// Shows or hides the marker; makes the first one if there is none.
    pub(crate) fn toggle_marker(&mut self) {
        self.panes.marker = !self.panes.marker;
        if self.panes.marker && self.base.pattern().markers.is_empty() && self.has_panels() {
            self.new_marker();
        }
        self.marker_view.fit();
        self.follow_marker();
    }

    /// Makes a marker and shows it: of the fabric without a marker that most panels are cut from; if all have
    /// one, of the fabric that most panels are cut from.
    pub(crate) fn new_marker(&mut self) {
        let pattern = self.base.pattern();
        let count = |id| pattern.panels.iter().filter(|p| p.fabric == id).count();
        let has_marker = |id| pattern.markers.iter().any(|m| m.fabric == id);
        let fabrics = pattern.fabrics.iter().map(|fabric| fabric.id);
        // Prefers a fabric without a marker, then the one that most panels are cut from.
        let Some(fabric) = fabrics.max_by_key(|id| (!has_marker(*id), count(*id))) else {
            return self.say_fault("the pattern has no fabric: draw a panel first".into());
        };
        let planned = plan::add_marker(&self.base, None, fabric);
        let id = planned.as_ref().ok().map(|(_, id)| *id);
        if self.edit(planned.map(|(edits, _)| edits), "Add marker") {
            self.marker_view.chosen = id;
            self.marker_view.fit();
            self.panes.marker = true;
            self.follow_marker();
        }
    }

    pub(crate) fn has_marker(&self) -> bool {
        self.marker_id().is_some()
    }

    pub(super) fn marker_id(&self) -> Option<MarkerId> {
        let markers = &self.session.project().pattern.markers;
        let chosen = self.marker_view.chosen;
        let found = markers.iter().find(|marker| Some(marker.id) == chosen);
        found.or(markers.first()).map(|marker| marker.id)
    }

    /// Brings the view up to date with the document, also while pieces are dragged.
    pub(crate) fn follow_marker(&mut self) {
        if !self.panes.marker {
            return;
        }
        let Some(id) = self.marker_id() else {
            return self.marker_view.clear(Ok(
                "There is no marker yet: \u{201c}New marker\u{201d} lays the pieces on fabric",
            ));
        };
        self.marker_view.chosen = Some(id);
        if let Some(words) = self.why_marker_is_empty(id) {
            return self.marker_view.clear(Ok(&words));
        }
        match self.session.marker_on_roll(id, self.marker_view.roll) {
            Ok(laid) => self.marker_view.follow(&laid),
            Err(error) => self.marker_view.clear(Err(error.to_string())),
        }
    }

    /// The bars and the view of the marker.
    pub(crate) fn marker_side(&mut self, ui: &mut Ui) {
        ui.horizontal_wrapped(|ui| self.marker_bar(ui));
        ui.horizontal_wrapped(|ui| self.search_bar(ui));
        self.laying_rows(ui);
        self.verdict_line(ui);
        for action in self.marker_view.show(ui) {
            self.do_marker(action);
        }
    }

    fn marker_bar(&mut self, ui: &mut Ui) {
        let pattern = self.base.pattern().clone();
        let Some(marker) = self.marker_id().and_then(|id| pattern.marker(id).cloned()) else {
            self.command_button(ui, &NEW_MARKER);
            return;
        };
        let mut chosen = marker.id;
        let label = ui.label("Marker").id;
        ComboBox::from_id_salt("marker")
            .selected_text(&marker.name)
            .show_ui(ui, |ui| {
                for known in &pattern.markers {
                    ui.selectable_value(&mut chosen, known.id, &known.name);
                }
            })
            .response
            .labelled_by(label);
        if chosen != marker.id {
            self.marker_view.chosen = Some(chosen);
            self.marker_view.roll = 0;
            self.marker_view.fit();
            self.follow_marker();
        }
        let label = ui.label("called").id;
        let size = egui::vec2(NAME_WIDTH, ui.spacing().interact_size.y);
        let layout = egui::Layout::left_to_right(egui::Align::Center);
        let id = egui::Id::unique(("marker name", marker.id));
        let entered = ui.allocate_ui_with_layout(size, layout, |ui| {
            let nothing = |_: &str| Ok(String::new());
            self.typed.field(ui, (id, label), &marker.name, nothing)
        });
        if let Entered::Text(text) = entered.inner {
            let planned = plan::rename(&self.base, marker.id.into(), &text);
            self.enter(planned, "Rename marker", (id, text));
        }
        self.command_button(ui, &NEW_MARKER);
        self.command_button(ui, &REMOVE_MARKER);
        ui.separator();
        self.order_fields(ui, &marker);
        ui.separator();
        self.cloth_fields(ui, &marker);
        ui.toggle_value(&mut self.marker_view.shows_laying, "Rolls and rules")
            .on_hover_text("How the fabric is laid, its rolls, and rules for single pieces");
    }

    /// Shows fields for the number of garments to cut: one for each size; and one for the wearer, if the
    /// wearer has none of the sizes or the marker has garments for the wearer.
    fn order_fields(&mut self, ui: &mut Ui, marker: &Marker) {
        let pattern = self.base.pattern().clone();
        let project = self.session.project();
        let is_for_wearer = project.size_name().is_none() || marker.quantity(None) > 0;
        let wearers = match pattern.sizes.is_empty() {
            true => Some((None, "Garments", "Garments on the marker".to_owned())),
            false => {
                let words = format!("Garments as in the window: {}", project.whose());
                is_for_wearer.then_some((None, "The wearer\u{2019}s", words))
            }
        };
        let mut rows: Vec<(Option<SizeId>, &str, String)> = wearers.into_iter().collect();
        for size in &pattern.sizes {
            let words = "Garments of this size on the marker".to_owned();
            rows.push((Some(size.id), &size.name, words));
        }
        for (size, name, meaning) in rows {
            let before = marker.quantity(size);
            let mut quantity = before;
            let label = kept_label(ui, name);
            let field = DragValue::new(&mut quantity)
                .range(0..=toile_pattern::MAX_GARMENTS)
                .speed(0.05)
                .update_while_editing(false);
            ui.add(field).on_hover_text(meaning).labelled_by(label);
            if quantity != before {
                let mut order = marker.order.clone();
                order.retain(|ordered| ordered.size != size);
                if quantity > 0 {
                    order.push(OrderedSize { size, quantity });
                }
                let place = |ordered: &OrderedSize| {
                    let mut all = pattern.sizes.iter();
                    all.position(|known| Some(known.id) == ordered.size)
                };
                order.sort_by_key(place);
                self.set_order(marker.id, order);
            }
        }
    }

    pub(super) fn set_order(&mut self, id: MarkerId, order: Vec<OrderedSize>) {
        let planned = plan::set_marker_order(&self.base, id, order);
        self.edit(planned, "Set order");
        self.marker_view.fit();
        self.follow_marker();
    }

    fn search_bar(&mut self, ui: &mut Ui) {
        self.command_button(ui, &SEARCH_MARKER);
        self.command_button(ui, &STOP_SEARCH);
        let label = ui.label("for").id;
        let chosen = &mut self.search_choice.seconds;
        ComboBox::from_id_salt("search seconds")
            .selected_text(format!("{chosen:.0} s"))
            .width(64.0)
            .show_ui(ui, |ui| {
                for seconds in SECONDS {
                    ui.selectable_value(chosen, seconds, format!("{seconds:.0} s"));
                }
            })
            .response
            .labelled_by(label);
        ui.separator();
        for command in [&TURN_PIECE, &TURN_OVER, &LOCK_PIECE, &TAKE_OFF] {
            self.command_button(ui, command);
        }
    }

    /// Shows a line with the result of the marker, or with the progress of the search. The line keeps its
    /// height, so that nothing below it moves.
    fn verdict_line(&mut self, ui: &mut Ui) {
        let size = egui::vec2(ui.available_width(), ui.spacing().interact_size.y);
        let (rect, _) = ui.allocate_exact_size(size, egui::Sense::hover());
        let layout = egui::Layout::left_to_right(egui::Align::Center);
        let line = egui::UiBuilder::new().max_rect(rect).layout(layout);
        ui.scope_builder(line, |ui| {
            let palette = Palette::of(ui.ctx());
            if let Some(searching) = &self.searching {
                let progress = searching.job.progress();
                let bar = egui::ProgressBar::new(progress.share as f32).desired_width(120.0);
                ui.add(bar);
                ui.add(egui::Label::new(progress.detail).truncate());
                return;
            }
            let mended = self.mend_button(ui);
            let (words, is_wrong) = self.marker_words();
            let colour = match (is_wrong, &mended) {
                (true, _) => palette.fault,
                (false, Some(_)) => palette.warning,
                (false, None) => palette.ink,
            };
            let words = match mended {
                Some(kept) if words.is_empty() => kept,
                Some(kept) => format!("{kept}; {words}"),
                None => words,
            };
            let words = RichText::new(words).color(colour);
            ui.add(egui::Label::new(words).truncate());
        });
    }

    /// Description of the marker's result, and whether it cannot be cut as it is laid.
    fn marker_words(&self) -> (String, bool) {
        let state = &self.marker_view.state;
        if state.laid + state.waiting == 0 {
            return (String::new(), false);
        }
        let unit = self.base.pattern().unit;
        let mut words = format!(
            "{} long, {:.1} % used",
            number::show(state.length, Want::Length, unit),
            100.0 * state.efficiency
        );
        if let Some(cost) = state.cost {
            let marker = self
                .marker_id()
                .and_then(|id| self.base.pattern().marker(id));
            let currency = marker.and_then(|marker| marker.cloth.currency.as_deref());
            let currency = currency.unwrap_or_default();
            words = format!("{words}, {cost:.2} {currency}");
        }
        if state.waiting > 0 {
            words = match self.marker_view.rolls.len() > 1 {
                true => format!("{words}; {} wait", state.waiting),
                false => {
                    let all = state.laid + state.waiting;
                    format!("{words}; {} of {all} wait", state.waiting)
                }
            };
        }
        if let Some(overlap) = state.overlaps.first() {
            let pattern = self.base.pattern();
            words = format!(
                "{words}; {} overlaps, the first of {}: {:.1} cm2 are cut twice",
                state.overlaps.len(),
                pattern.piece_words(overlap.pieces[0]),
                1e4 * overlap.region.iter().map(|part| part.area()).sum::<f64>()
            );
        }
        if let Some(outside) = state.outside.first() {
            words = format!(
                "{words}; {} {:.1} mm off the fabric",
                self.base.pattern().piece_words(outside.piece),
                1e3 * outside.by
            );
        }
        let is_wrong = !(state.overlaps.is_empty() && state.outside.is_empty());
        (words, is_wrong)
    }

    fn do_marker(&mut self, action: MarkerAction) {
        let Some(id) = self.marker_id() else { return };
        if self.is_searching() {
            let words = "The search is laying the pieces: Stop search keeps the best so far";
            self.notice = Notice::news(words);
            return;
        }
        let selected = self.marker_view.selection.clone();
        match action {
            MarkerAction::Drag(pieces, way) => {
                // The vector is measured from the positions before the drag.
                match plan::move_pieces(&self.base, (id, &pieces), way.into()) {
                    Ok(edits) => self.preview(&edits),
                    Err(error) => self.say_fault(error.to_string()),
                }
                self.follow_marker();
            }
            MarkerAction::Drop(pieces, way, how) => self.drop_pieces((id, &pieces), way, how),
            MarkerAction::Leave => {
                self.session.cancel();
                self.refresh();
                self.follow_marker();
            }
            MarkerAction::Lay(piece, at, how) => self.lay_piece((id, piece), at, how),
            MarkerAction::Turn(centre, angle) => {
                let planned =
                    plan::turn_pieces(&self.base, (id, &selected), (angle, centre.into()));
                self.marker_edit(planned, "Turn pieces");
            }
            MarkerAction::Flip(line) => {
                let planned = plan::flip_pieces(&self.base, (id, &selected), line);
                self.marker_edit(planned, "Turn pieces over");
            }
            MarkerAction::Lock => {
                let marker = self.base.pattern().marker(id);
                let all_locked = selected.iter().all(|piece| {
                    let laid = marker.and_then(|marker| marker.placement(*piece));
                    laid.is_some_and(|laid| laid.locked)
                });
                let planned = plan::lock_pieces(&self.base, (id, &selected), !all_locked);
                let label = if all_locked {
                    "Unlock pieces"
                } else {
                    "Lock pieces"
                };
                self.marker_edit(planned, label);
            }
            MarkerAction::TakeOff => {
                let planned = plan::take_off_pieces(&self.base, id, &selected);
                self.marker_edit(planned, "Take pieces off");
            }
        }
    }

    fn marker_edit(&mut self, planned: Result<Vec<Edit>, EditError>, label: &str) {
        if !self.marker_view.selection.is_empty() {
            self.edit(planned, label);
            self.follow_marker();
        }
    }

    /// Performs an action of the marker view on the selected pieces, if there is one.
    pub(crate) fn on_pieces(&mut self, action: fn(&MarkerView) -> Option<MarkerAction>) {
        if let Some(action) = action(&self.marker_view) {
            self.do_marker(action);
        }
    }

    pub(crate) fn has_pieces(&self) -> bool {
        self.panes.marker && !self.marker_view.selection.is_empty()
    }

    pub(crate) fn remove_marker(&mut self) {
        if let Some(id) = self.marker_id() {
            let planned = plan::remove_marker(&self.base, id);
            self.edit(planned, "Remove marker");
            self.marker_view.chosen = None;
            self.follow_marker();
        }
    }

    /// Searches for a layout of short length, on a thread of its own.
    pub(crate) fn search_marker(&mut self) {
        let Some(id) = self.marker_id() else { return };
        // A piece that is being dragged returns to its place first; the search lays it.
        self.session.cancel();
        self.refresh();
        let search = match self.session.marker_search(id) {
            Ok(search) => search,
            Err(error) => return self.say_fault(error.to_string()),
        };
        let how = (Start::Anew, Search::seconds(self.search_choice.seconds));
        let unit = self.base.pattern().unit;
        self.panes.marker = true;
        let newest = Arc::default();
        let told = Arc::clone(&newest);
        self.searching = Some(Searching {
            newest,
            began: Instant::now(),
            seconds: self.search_choice.seconds,
            is_stopped: false,
            job: Job::start(move |follower| {
                let stop = follower.stop_flag().ok_or(SessionError::Cancelled)?;
                let laid = search.laid();
                let mut before = None;
                let mut report = |progress: &toile_session::SearchProgress| {
                    if let Some(marker) = &progress.marker
                        && !before.as_ref().is_some_and(|own| Arc::ptr_eq(own, marker))
                    {
                        before = Some(Arc::clone(marker));
                        let seen = Some(laid.under_way(marker));
                        *told.lock().unwrap_or_else(PoisonError::into_inner) = seen;
                    }
                    let mut words = match progress.length {
                        Some(length) => {
                            format!("{} of fabric", number::show(length, Want::Length, unit))
                        }
                        None => progress.words(),
                    };
                    if let Some(efficiency) = progress.efficiency {
                        words = format!("{words}, {:.1} %", 100.0 * efficiency);
                    }
                    if let Some(cost) = progress.cost {
                        words = format!("{words}, {cost:.2}");
                    }
                    follower
                        .progress("searching", progress.done, &words)
                        .is_continue()
                };
                let mut follow = SearchWatcher {
                    report: &mut report,
                    stop,
                };
                search.run(how, &mut follow)
            }),
        });
    }

    pub(crate) fn is_searching(&self) -> bool {
        self.searching.is_some()
    }

    /// Ends the search with the best marker so far.
    pub(crate) fn stop_search(&mut self) {
        if let Some(searching) = &mut self.searching {
            searching.is_stopped = true;
            searching.job.cancel();
        }
    }

    /// Applies the result of a search.
    pub(super) fn follow_search(&mut self) {
        let Some(searching) = &self.searching else {
            return;
        };
        let Some(result) = searching.job.result() else {
            let mut newest = searching.newest.lock();
            let newest = newest.as_mut().ok().and_then(|newest| newest.take());
            if let Some(laid) = newest.filter(|laid| Some(laid.marker().id) == self.marker_id()) {
                self.marker_view.follow(&laid);
                self.marker_view.keep_in_view();
            }
            return;
        };
        let early = searching.ended_early();
        self.searching = None;
        self.follow_marker();
        match result.map(|found| self.session.adopt_marker(found)) {
            Ok(Ok(Some(events))) => {
                self.handle_events(&events);
                self.follow_marker();
                self.marker_view.keep_in_view();
                let (words, _) = self.marker_words();
                let early = early.map_or_else(String::new, |early| format!("; {early}"));
                self.notice = Notice::news(format!("{words}{early}"));
            }
            Ok(Ok(None)) => {
                self.notice = Notice::warning(
                    "the pattern changed while the marker was searched for: search again",
                );
            }
            Ok(Err(error)) => self.notice = Notice::fault(error.to_string()),
            Err(words) => self.notice = Notice::fault(words),
        }
    }
}
