//! The selection, and the parts that can be selected. View state: not in the document, not undone.

use toile_pattern::{
    CurveId, EdgeId, GuideId, LineId, LineKind, NotchId, OperationId, PanelId, PartId, Pattern,
    PointId, SeamId, SheetId,
};

/// A part of the pattern that can be selected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Item {
    /// A point of a sheet.
    Point(PointId),
    /// A curve of a sheet.
    Curve(CurveId),
    /// An edge of a panel.
    Edge(PanelId, EdgeId),
    /// A hole or a line inside a panel.
    Line(PanelId, LineId),
    /// A notch of a panel.
    Notch(PanelId, NotchId),
    /// A dart, a fold or another operation of a panel.
    Operation(PanelId, OperationId),
    /// A whole panel.
    Panel(PanelId),
    /// A seam.
    Seam(SeamId),
    /// A whole sheet.
    Sheet(SheetId),
    /// A guide.
    Guide(GuideId),
}

impl Item {
    /// All parts of a pattern: panels and their parts, seams, sheets and their parts, guides.
    pub fn all(pattern: &Pattern) -> Vec<Self> {
        let mut all = Vec::new();
        for panel in &pattern.panels {
            let id = panel.id;
            all.push(Self::Panel(id));
            all.extend(panel.edges().map(|edge| Self::Edge(id, edge.id)));
            let inner = panel
                .lines
                .iter()
                .filter(|line| line.kind != LineKind::Outline);
            all.extend(inner.map(|line| Self::Line(id, line.id)));
            all.extend(
                panel
                    .operations
                    .iter()
                    .map(|step| Self::Operation(id, step.id)),
            );
            all.extend(panel.notches.iter().map(|notch| Self::Notch(id, notch.id)));
        }
        all.extend(pattern.seams.iter().map(|seam| Self::Seam(seam.id)));
        for sheet in &pattern.sheets {
            all.push(Self::Sheet(sheet.id));
            all.extend(sheet.points.iter().map(|point| Self::Point(point.id)));
            all.extend(sheet.curves.iter().map(|curve| Self::Curve(curve.id)));
        }
        all.extend(pattern.guides.iter().map(|guide| Self::Guide(guide.id)));
        all
    }

    /// Reference to the part in the document.
    pub fn part(self) -> PartId {
        match self {
            Self::Point(id) => id.into(),
            Self::Curve(id) => id.into(),
            Self::Edge(_, id) => id.into(),
            Self::Line(_, id) => id.into(),
            Self::Notch(_, id) => id.into(),
            Self::Operation(_, id) => id.into(),
            Self::Panel(id) => id.into(),
            Self::Seam(id) => id.into(),
            Self::Sheet(id) => id.into(),
            Self::Guide(id) => id.into(),
        }
    }

    /// The panel that the part is or belongs to.
    pub fn panel(self) -> Option<PanelId> {
        match self {
            Self::Edge(panel, _)
            | Self::Line(panel, _)
            | Self::Notch(panel, _)
            | Self::Operation(panel, _)
            | Self::Panel(panel) => Some(panel),
            Self::Point(_) | Self::Curve(_) | Self::Seam(_) | Self::Sheet(_) | Self::Guide(_) => {
                None
            }
        }
    }

    /// Kind and name of the part, in words; `None` if the pattern does not have it.
    pub fn words(self, pattern: &Pattern) -> Option<String> {
        let panel = |id| pattern.panel(id);
        let mut sheets = pattern.sheets.iter();
        Some(match self {
            Self::Point(id) => {
                let (sheet, point) = pattern.point(id)?;
                format!("Point {} of {}", point.name, sheet.name)
            }
            Self::Curve(id) => {
                let sheet = sheets.find(|sheet| sheet.curve(id).is_some())?;
                format!("Curve {} of {}", sheet.curve(id)?.name, sheet.name)
            }
            Self::Edge(of, id) => {
                let owner = pattern.owner_of(of, id.into())?;
                format!("Edge {} of {}", owner.edge(id)?.name, panel(of)?.name)
            }
            Self::Line(of, id) => {
                let owner = pattern.owner_of(of, id.into())?;
                format!("Line {} of {}", owner.line(id)?.name, panel(of)?.name)
            }
            Self::Notch(of, id) => {
                let owner = pattern.owner_of(of, id.into())?;
                let number = owner.notches.iter().position(|notch| notch.id == id)? + 1;
                format!("Notch {number} of {}", panel(of)?.name)
            }
            Self::Operation(of, id) => {
                let panel = panel(of)?;
                let owner = pattern.owner_of(of, id.into())?;
                let found = owner.operations.iter().find(|step| step.id == id)?;
                let kind = found.kind.word();
                let kind = kind[..1].to_uppercase() + &kind[1..];
                match found.name.eq_ignore_ascii_case(&kind) {
                    true => format!("{kind} of {}", panel.name),
                    false => format!("{kind} {} of {}", found.name, panel.name),
                }
            }
            Self::Panel(id) => format!("Panel {}", panel(id)?.name),
            Self::Seam(id) => format!("Seam {}", pattern.seam(id)?.name),
            Self::Sheet(id) => format!("Sheet {}", pattern.sheet(id)?.name),
            Self::Guide(id) => {
                let words = pattern.guide_words(id)?;
                words[..1].to_uppercase() + &words[1..]
            }
        })
    }
}

/// The selected parts, in the order they were selected.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Selection {
    items: Vec<Item>,
}

impl Selection {
    /// A selection of one part.
    pub fn one(item: Item) -> Self {
        Self { items: vec![item] }
    }

    /// All selected parts.
    pub fn items(&self) -> &[Item] {
        &self.items
    }

    /// Whether nothing is selected.
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    /// Whether a part is selected.
    pub fn contains(&self, item: Item) -> bool {
        self.items.contains(&item)
    }

    /// The selected part, if exactly one is selected.
    pub fn single(&self) -> Option<Item> {
        match self.items[..] {
            [item] => Some(item),
            _ => None,
        }
    }

    /// The selected points.
    pub fn points(&self) -> Vec<PointId> {
        let points = self.items.iter().filter_map(|item| match item {
            Item::Point(id) => Some(*id),
            _ => None,
        });
        points.collect()
    }

    /// The panels that are selected as a whole.
    pub fn panels(&self) -> Vec<PanelId> {
        let panels = self.items.iter().filter_map(|item| match item {
            Item::Panel(id) => Some(*id),
            _ => None,
        });
        panels.collect()
    }

    /// The sheets that are selected as a whole.
    pub fn sheets(&self) -> Vec<SheetId> {
        let sheets = self.items.iter().filter_map(|item| match item {
            Item::Sheet(id) => Some(*id),
            _ => None,
        });
        sheets.collect()
    }

    /// Adds a part to the selection, or removes it if it is selected.
    pub fn toggle(&mut self, item: Item) {
        match self.items.iter().position(|known| *known == item) {
            Some(k) => {
                self.items.remove(k);
            }
            None => self.items.push(item),
        }
    }

    /// Adds a part to the selection, unless it is selected.
    pub fn add(&mut self, item: Item) {
        if !self.contains(item) {
            self.items.push(item);
        }
    }

    /// Removes parts that the pattern no longer has.
    pub fn follow(&mut self, pattern: &Pattern) {
        self.items.retain(|item| item.words(pattern).is_some());
    }
}

impl FromIterator<Item> for Selection {
    fn from_iter<Items: IntoIterator<Item = Item>>(items: Items) -> Self {
        let mut selection = Self::default();
        items.into_iter().for_each(|item| selection.add(item));
        selection
    }
}
