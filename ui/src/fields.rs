//! Text fields: text typed into a field that was just entered replaces the old text.

use crate::glossary::meaning;
use crate::theme::Palette;
use egui::text::LayoutJob;
use egui::text::{CCursor, CCursorRange};
use egui::{
    Align2, Area, Color32, Galley, Key, Modifiers, Order, Rect, Response, RichText, Role, Sense,
    TextBuffer, TextEdit, TextStyle, Ui, WidgetInfo, vec2,
};
use std::collections::HashMap;
use std::sync::Arc;
use toile_pattern::Evaluation;

/// Largest number of names that are proposed to complete a typed text.
const PROPOSED: usize = 8;
/// Share of a field's width that its text gets, if a value stands beside the text (1).
const TEXT_SHARE: f32 = 0.5;
/// Height that words under a field need above the lower edge of the window; with less room they stand above
/// the field (pixels).
const UNDER: f32 = 64.0;
/// Width that words under a field can take even if the field is narrower (pixels).
const MIN_WIDTH_UNDER: f32 = 270.0;

/// Grey words inside a field, beside its text. They use the room of the field, so that no widget moves when
/// they change.
#[derive(Clone, Debug, Default)]
pub struct Beside {
    /// Default that applies while the field is empty.
    pub hint: String,
    /// Value of the text, for instance of a formula; hidden while the text is edited.
    pub value: String,
}

/// Size of a field of one line, and the width of text that fits (pixels).
#[derive(Clone, Copy, Debug)]
struct Room {
    size: egui::Vec2,
    text: f32,
}

/// A text field as wide as there is room. While it is edited a longer text is shown whole, in as many lines
/// as it needs, which cover the widgets below; otherwise it is shown whole in a tooltip.
pub fn text_field(ui: &mut Ui, id: egui::Id, text: &mut String) -> Response {
    text_field_beside(ui, id, text, &Beside::default())
}

fn text_field_beside(ui: &mut Ui, id: egui::Id, text: &mut String, beside: &Beside) -> Response {
    let had_focus = had_focus(ui, id);
    // Text typed in the frame in which the field got the focus replaces the old text, too.
    let given_focus = !had_focus && ui.memory(|memory| memory.has_focus(id));
    if given_focus {
        choose_all(ui, id, text);
    }
    let before = (!had_focus).then(|| text.clone());
    let is_typed_into = ui.memory(|memory| memory.has_focus(id));
    let room: Option<Room> = ui.data(|data| data.get_temp(id.with("room")));
    let long = room.filter(|room| is_typed_into && line_of(ui, text).size().x > room.text);
    let response = match long {
        Some(room) if is_measured(ui, id, room) => in_lines(ui, id, text, room),
        _ => in_one_line(ui, id, text, (beside, is_typed_into)),
    };
    if response.has_focus() {
        note_focus(ui, id);
    }
    if response.has_focus() && !had_focus {
        // A field that got the focus by a key may be out of sight.
        ui.scroll_to_rect(response.rect, None);
        // The click that gave the focus has set the cursor: the whole text is selected again.
        if before.is_some_and(|before| before == *text) {
            choose_all(ui, id, text);
        }
    }
    response
}

/// A value as shown inside a field beside its text; truncated if it is longer than the room. The text gets
/// up to half of the field.
fn value_beside(ui: &Ui, value: &str, text: &str) -> String {
    let padding = 4.0 * ui.spacing().button_padding.x;
    let whole = ui.available_width() - padding;
    let room = whole - line_of(ui, text).size().x.min(TEXT_SHARE * whole);
    let font = TextStyle::Small.resolve(ui.style());
    let width = |words: String| {
        let galley = ui
            .painter()
            .layout_no_wrap(words, font.clone(), Color32::PLACEHOLDER);
        galley.size().x
    };
    if width(value.to_owned()) <= room {
        return value.to_owned();
    }
    let ends = value.char_indices().map(|(at, _)| at).rev();
    let mut shorter = ends.map(|at| format!("{}\u{2026}", value[..at].trim_end()));
    shorter
        .find(|words| width(words.clone()) <= room)
        .unwrap_or_default()
}

fn in_one_line(
    ui: &mut Ui,
    id: egui::Id,
    text: &mut String,
    (beside, is_typed_into): (&Beside, bool),
) -> Response {
    let soft = Palette::of(ui.ctx()).ink_soft;
    let grey = |words: &str| RichText::new(words).small().color(soft);
    let value = match is_typed_into {
        true => String::new(),
        false => value_beside(ui, &beside.value, text),
    };
    let mut field = TextEdit::singleline(text)
        .id(id)
        .desired_width(f32::INFINITY);
    if !beside.hint.is_empty() {
        field = field.hint_text(grey(&beside.hint));
    }
    if !value.is_empty() {
        field = field.suffix(grey(&value));
    }
    let shown = field.show(ui);
    let response = shown.response.response;
    let told = [&beside.hint, &beside.value].map(|words| &**words);
    let told = told.into_iter().find(|words| !words.is_empty());
    if let Some(words) = told {
        let describe = |node: &mut egui::accesskit::Node| node.set_description(words);
        ui.ctx().accesskit_node_builder(response.id, describe);
    }
    let room = shown.text_clip_rect.width();
    if !is_typed_into || beside.value.is_empty() {
        let size = response.rect.size();
        let room = Room { size, text: room };
        ui.data_mut(|data| data.insert_temp(id.with("room"), room));
    }
    match shown.galley.size().x > room + 0.5 {
        true => response.on_hover_text(text.as_str()),
        false => response,
    }
}

/// Area that a field of several lines is shown in.
fn over(id: egui::Id) -> Area {
    Area::new(id.with("lines"))
        .order(Order::Foreground)
        .fade_in(false)
}

/// Whether the area of a field of several lines was shown before. In the first frame the area is only
/// measured, and takes no keys.
fn is_measured(ui: &Ui, id: egui::Id, room: Room) -> bool {
    let over = over(id);
    let is_known = egui::AreaState::load(ui.ctx(), over.layer().id).is_some();
    if !is_known {
        let over = over.fixed_pos(ui.next_widget_position());
        over.show(ui.ctx(), |ui| ui.allocate_space(room.size));
        ui.ctx().request_repaint();
    }
    is_known
}

/// Shows a field that is edited in several lines, above the widgets below it.
fn in_lines(ui: &mut Ui, id: egui::Id, text: &mut String, room: Room) -> Response {
    let (place, _) = ui.allocate_exact_size(room.size, Sense::hover());
    let mut lines = broken;
    let field = TextEdit::singleline(text)
        .id(id)
        .desired_width(f32::INFINITY)
        .layouter(&mut lines);
    let shown = over(id).fixed_pos(place.min).show(ui.ctx(), |ui| {
        ui.set_width(place.width());
        field.show(ui).response.response
    });
    shown.inner
}

/// Shows words and names under a field that is edited. They cover the widgets below, so that these do not
/// move. Returns the rectangle of the field and these words on the screen.
fn under(ui: &Ui, id: egui::Id, field: Rect, add: impl FnOnce(&mut Ui)) -> Rect {
    if !ui.is_rect_visible(field) {
        return field;
    }
    let is_low = field.bottom() + UNDER > ui.ctx().content_rect().bottom();
    let (pivot, at) = match is_low {
        true => (Align2::LEFT_BOTTOM, field.left_top() - vec2(0.0, 2.0)),
        false => (Align2::LEFT_TOP, field.left_bottom() + vec2(0.0, 2.0)),
    };
    let over = Area::new(id)
        .order(Order::Foreground)
        .pivot(pivot)
        .fixed_pos(at)
        .fade_in(false);
    let shown = over.show(ui.ctx(), |ui| {
        let frame = egui::Frame::popup(ui.style()).inner_margin(4.0);
        frame.show(ui, |ui| {
            ui.set_max_width(field.width().max(MIN_WIDTH_UNDER));
            add(ui);
        });
    });
    field.union(shown.response.rect)
}

/// Lays out a text in one line.
fn line_of(ui: &Ui, text: &str) -> Arc<Galley> {
    let font = TextStyle::Body.resolve(ui.style());
    let colour = ui.visuals().text_color();
    ui.fonts_mut(|fonts| fonts.layout_no_wrap(text.to_owned(), font, colour))
}

/// Lays out a text in lines of at most a width.
fn broken(ui: &Ui, text: &dyn TextBuffer, width: f32) -> Arc<Galley> {
    let font = TextStyle::Body.resolve(ui.style());
    let colour = ui.visuals().text_color();
    let mut job = LayoutJob::simple(text.as_str().to_owned(), font, colour, width);
    job.keep_trailing_whitespace = true;
    ui.fonts_mut(|fonts| fonts.layout_job(job))
}

/// Selects the whole text of a field.
pub fn choose_all(ui: &Ui, id: egui::Id, text: &str) {
    let all = CCursorRange::two(CCursor::new(0), CCursor::new(text.chars().count()));
    let mut state = egui::text_edit::TextEditState::load(ui.ctx(), id).unwrap_or_default();
    state.cursor.set_char_range(Some(all));
    state.store(ui.ctx(), id);
}

/// Whether a field had the focus in the last frame. A field of a dialog that was closed and opened again
/// since does not count.
fn had_focus(ui: &Ui, id: egui::Id) -> bool {
    let frame: Option<u64> = ui.data(|data| data.get_temp(id.with("had focus")));
    frame.is_some_and(|frame| frame + 1 >= ui.ctx().cumulative_frame_nr())
}

/// Records that a field has the focus in this frame.
fn note_focus(ui: &Ui, id: egui::Id) {
    let frame = ui.ctx().cumulative_frame_nr();
    ui.data_mut(|data| data.insert_temp(id.with("had focus"), frame));
}

/// Width of labels left of their fields (pixels).
const LABEL: f32 = 92.0;

/// Shows a field with a grey label left of it; `add` shows the field, given the id of the label. Fields
/// below each other are aligned.
pub fn labelled<R>(ui: &mut Ui, name: &str, add: impl FnOnce(&mut Ui, egui::Id) -> R) -> R {
    let soft = Palette::of(ui.ctx()).ink_soft;
    ui.horizontal_top(|ui| {
        let height = ui.spacing().interact_size.y;
        let place = ui.vertical(|ui| {
            ui.set_width(LABEL);
            ui.set_min_height(height);
            // The first line of the label is level with the larger text of its field.
            let line = ui.text_style_height(&TextStyle::Small);
            ui.add_space((0.5 * (height - line)).max(0.0).ceil());
            let words = RichText::new(capitalised(name)).small().color(soft);
            let label = ui.add(egui::Label::new(words).wrap());
            // Screen readers get the name as messages write it.
            label.widget_info(|| WidgetInfo::labeled(Role::Label, true, name));
            match meaning(name) {
                Some(meaning) => label.on_hover_text(meaning.replace('`', "")).id,
                None => label.id,
            }
        });
        ui.vertical(|ui| add(ui, place.inner)).inner
    })
    .inner
}

/// Words with an initial capital, for labels.
fn capitalised(words: &str) -> String {
    let mut letters = words.chars();
    let first = letters.next().into_iter().flat_map(char::to_uppercase);
    first.chain(letters).collect()
}

/// Shows a drop-down list beside its label. A value without an entry in `of` is shown empty.
pub fn choice<T: Copy + PartialEq>(ui: &mut Ui, label: &str, of: &[(T, &str)], value: &mut T) {
    let words = of.iter().find(|known| known.0 == *value);
    labelled(ui, label, |ui, name| {
        let list = egui::ComboBox::from_id_salt(label)
            .selected_text(words.map_or("", |known| known.1))
            .width(ui.available_width())
            .truncate()
            .show_ui(ui, |ui| {
                for (one, words) in of {
                    ui.selectable_value(value, *one, *words);
                }
            });
        list.response.labelled_by(name);
    });
}

/// Texts that are being typed into fields.
#[derive(Default)]
pub struct TypedTexts {
    typed: HashMap<egui::Id, Typed>,
    /// The number field that has the focus.
    number: Option<egui::Id>,
    /// Text that a click would insert into the focused number field: the length of the part under the
    /// pointer.
    offered: Option<String>,
    /// Whether a click of this frame inserted text into the focused number field.
    given: bool,
    /// Completion that a click on the name under the pointer would give the focused number field.
    proposed: Option<String>,
    /// Completion that the arrow-down key would give the focused number field.
    first: Option<String>,
}

/// A text that is being typed, and the error in it.
#[derive(Default)]
struct Typed {
    text: String,
    fault: String,
    /// Whether the text is being edited, and differs from the old text.
    is_begun: bool,
    /// Rectangle of the field and the words under the field, on the screen.
    place: Option<Rect>,
}

/// Outcome of a text field in a frame.
pub enum Entered {
    /// No outcome yet.
    Nothing,
    /// The text was entered.
    Text(String),
    /// The field was left without entering.
    Left,
}

impl TypedTexts {
    /// A text field that keeps the typed text until it is entered or left.
    pub fn field(
        &mut self,
        ui: &mut Ui,
        (id, label): (egui::Id, egui::Id),
        shown: &str,
        preview: impl FnOnce(&str) -> Result<String, String>,
    ) -> Entered {
        self.field_beside(ui, (id, label), (shown, &Beside::default()), preview)
    }

    fn field_beside(
        &mut self,
        ui: &mut Ui,
        (id, label): (egui::Id, egui::Id),
        (shown, beside): (&str, &Beside),
        preview: impl FnOnce(&str) -> Result<String, String>,
    ) -> Entered {
        let mut text = self
            .typed
            .get(&id)
            .map_or(shown, |typed| &typed.text)
            .to_owned();
        let response = text_field_beside(ui, id, &mut text, beside).labelled_by(label);
        if response.gained_focus() || response.changed() {
            let typed = self.typed.entry(id).or_default();
            typed.text.clone_from(&text);
            typed.fault.clear();
        }
        let mut entered = Entered::Nothing;
        if response.lost_focus() {
            let escaped = ui.input(|input| input.key_pressed(egui::Key::Escape));
            let is_new = text.trim() != shown;
            self.typed.remove(&id);
            entered = match escaped || !is_new {
                true => Entered::Left,
                false => Entered::Text(text.trim().to_owned()),
            };
        }
        if let Some(typed) = self.typed.get_mut(&id) {
            let palette = Palette::of(ui.ctx());
            let (words, colour): (String, Color32) = match typed.fault.is_empty() {
                false => (typed.fault.clone(), palette.fault),
                true if typed.text.trim() == shown => (String::new(), palette.ink_soft),
                true => match preview(&typed.text) {
                    Ok(words) => (words, palette.ink_soft),
                    Err(words) => (words, palette.fault),
                },
            };
            typed.place = Some(match words.is_empty() {
                true => response.rect,
                false => under(ui, id.with("told"), response.rect, |ui| {
                    ui.label(RichText::new(words).small().color(colour));
                }),
            });
        }
        entered
    }

    /// A text field for a number. A click on a part inserts its length, and names that complete the typed
    /// text are proposed: see [`Self::show_proposals`].
    pub fn number_field(
        &mut self,
        ui: &mut Ui,
        (id, label): (egui::Id, egui::Id),
        (shown, beside): (&str, &Beside),
        preview: impl FnOnce(&str) -> Result<String, String>,
    ) -> Entered {
        let before = self.typed.get(&id).map(|typed| typed.text.clone());
        if self.number == Some(id)
            && let Some(text) = self.first.take()
            && ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::ArrowDown))
        {
            self.complete(ui, id, text);
        }
        let entered = self.field_beside(ui, (id, label), (shown, beside), preview);
        let has_focus = ui.memory(|memory| memory.has_focus(id));
        let clicked = ui.input(|input| input.pointer.any_pressed() || input.pointer.any_released());
        if self.number == Some(id) && !has_focus && clicked {
            if let Some(text) = self.proposed.take() {
                self.complete(ui, id, text);
                self.given = true;
                return Entered::Nothing;
            }
            if let Some(words) = self.offered.take() {
                // A text that is unchanged is replaced; a text that was typed is continued.
                let begun = before.filter(|text| text != shown).unwrap_or_default();
                self.complete(ui, id, begun + &words);
                self.given = true;
                return Entered::Nothing;
            }
        }
        match has_focus {
            true => self.number = Some(id),
            false if self.number == Some(id) => self.number = None,
            false => {}
        }
        if let Some(typed) = self.typed.get_mut(&id) {
            typed.is_begun = has_focus && typed.text != shown;
        }
        entered
    }

    /// Shows names that complete the text in a number field, under the field. Arrow-down inserts the first
    /// name, a click inserts the clicked one.
    pub fn show_proposals(&mut self, ui: &mut Ui, id: egui::Id, base: &Evaluation) {
        let Some(typed) = self.typed.get(&id).filter(|typed| typed.is_begun) else {
            return;
        };
        self.proposed = None;
        let found = base.names().completions(&typed.text);
        self.first = found.first().map(|first| first.text.clone());
        let Some(place) = typed.place.filter(|_| !found.is_empty()) else {
            return;
        };
        let proposed = &mut self.proposed;
        under(ui, id.with("names"), place, |ui| {
            ui.horizontal_wrapped(|ui| {
                let spacing = ui.spacing_mut();
                spacing.item_spacing = vec2(4.0, 4.0);
                spacing.interact_size.y = 0.0;
                spacing.button_padding = vec2(5.0, 2.0);
                for completion in found.into_iter().take(PROPOSED) {
                    let words = RichText::new(&completion.word).small();
                    let button = ui.add(egui::Button::new(words).sense(Sense::hover()));
                    if button.contains_pointer() {
                        *proposed = Some(completion.text);
                    }
                }
            });
        });
    }

    /// Puts a text into a field that is edited, and continues editing.
    fn complete(&mut self, ui: &Ui, id: egui::Id, text: String) {
        let typed = self.typed.entry(id).or_default();
        typed.text = text;
        typed.fault.clear();
        ui.memory_mut(|memory| memory.request_focus(id));
        self.put_cursor_last(ui, id);
    }

    fn put_cursor_last(&self, ui: &Ui, id: egui::Id) {
        let length = self
            .typed
            .get(&id)
            .map_or(0, |typed| typed.text.chars().count());
        let mut state = egui::text_edit::TextEditState::load(ui.ctx(), id).unwrap_or_default();
        let last = CCursorRange::one(CCursor::new(length));
        state.cursor.set_char_range(Some(last));
        state.store(ui.ctx(), id);
        // The field counts as focused before: otherwise its whole text would be selected.
        note_focus(ui, id);
    }

    /// Whether a number field has the focus, so that a click on a part inserts its length.
    pub fn takes_parts(&self) -> bool {
        self.number.is_some()
    }

    /// Sets the text that a click would insert into the number that is being typed.
    pub fn offer(&mut self, words: Option<String>) {
        self.offered = words;
    }

    /// Whether a number field used the click of this frame.
    pub fn took_click(&mut self) -> bool {
        std::mem::take(&mut self.given)
    }

    /// Keeps a text in its field, and shows the error in it.
    pub fn refuse(&mut self, id: egui::Id, text: String, fault: String) {
        let typed = Typed {
            text,
            fault,
            ..Typed::default()
        };
        self.typed.insert(id, typed);
    }
}
