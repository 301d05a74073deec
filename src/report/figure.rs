//! A figure as plain data: two axes and what stands between them.
//!
//! One description serves three ends: the interactive figure of the page, its still picture
//! (print, no scripts), and the stored form from which the page is drawn again.

use serde::{Deserialize, Serialize};

/// Scale of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Scale {
    /// Even steps.
    Linear,
    /// Even ratios; values that are not positive are left out.
    Log,
}

/// What an item of a figure shows: picks its colour, its dash pattern and its marker.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// What was measured.
    Measured,
    /// The model as handed in.
    Before,
    /// The extended or trained model.
    After,
    /// A law that was named.
    Law,
    /// An estimate without an assumed shape.
    Free,
    /// A noise floor or a confidence band.
    Floor,
    /// A remark, such as where a part of the record begins.
    Quiet,
    /// Other laws of a place, which are drawn when they are asked for.
    Other1,
    Other2,
    Other3,
    Other4,
}

/// Roles of other laws, in their order.
pub(super) const OTHERS: [Role; 4] = [Role::Other1, Role::Other2, Role::Other3, Role::Other4];

impl Role {
    /// Class of the style sheet.
    pub(super) fn class(self) -> &'static str {
        match self {
            Self::Measured => "measured",
            Self::Before => "before",
            Self::After => "after",
            Self::Law => "law",
            Self::Free => "free",
            Self::Floor => "floor",
            Self::Quiet => "quiet",
            Self::Other1 => "other1",
            Self::Other2 => "other2",
            Self::Other3 => "other3",
            Self::Other4 => "other4",
        }
    }
}

/// What is drawn.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Shape {
    /// A line through (x, y).
    Line(Vec<(f64, f64)>),
    /// A line through (x, a - b): a simulation stored as measured minus residual.
    Difference(Vec<(f64, f64)>, Vec<f64>),
    /// A band between two values at every x: (x, low, high).
    Band(Vec<(f64, f64, f64)>),
    /// Dots with bars of so much up and down: (x, y, half length).
    Dots(Vec<(f64, f64, f64)>),
    /// A level line.
    Level(f64),
    /// An upright line.
    Upright(f64),
}

impl Shape {
    /// The points of a line or a difference.
    pub fn points(&self) -> Option<std::borrow::Cow<'_, [(f64, f64)]>> {
        match self {
            Self::Line(points) => Some(points.as_slice().into()),
            Self::Difference(a, b) => {
                let points = a.iter().zip(b).map(|(&(x, y), minus)| (x, y - minus));
                Some(points.collect::<Vec<_>>().into())
            }
            _ => None,
        }
    }
}

/// One thing in a figure.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Item {
    pub shape: Shape,
    pub role: Role,
    /// Its name in the legend; empty: it is not listed.
    pub label: String,
    /// Whether it is switched off at first.
    pub off: bool,
}

/// A figure with two axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    pub(super) title: String,
    pub(super) x: (String, Scale),
    pub(super) y: (String, Scale),
    pub(super) height: f64,
    pub(super) items: Vec<Item>,
    /// What stands at 1, 2, .. along x, instead of numbers.
    pub(super) names: Vec<String>,
    /// Figures of one link share their range along x.
    pub(super) link: Option<String>,
    /// Range along x that is shown at first; all where absent.
    pub(super) view: Option<(f64, f64)>,
    /// Whether a strip above the first figure of its link shows the whole of this one.
    pub(super) overview: bool,
}

impl Figure {
    /// An empty figure with the names of its axes.
    pub fn new(x: &str, y: &str) -> Self {
        Self {
            title: format!("{y} against {x}"),
            x: (x.into(), Scale::Linear),
            y: (y.into(), Scale::Linear),
            height: 260.0,
            items: vec![],
            names: vec![],
            link: None,
            view: None,
            overview: false,
        }
    }

    /// The same with a title, which the page shows above it.
    #[must_use]
    pub fn titled(mut self, title: &str) -> Self {
        self.title = title.into();
        self
    }

    /// The same with names at 1, 2, .. along x.
    #[must_use]
    pub fn named(mut self, names: &[String]) -> Self {
        self.names = names.to_vec();
        self
    }

    /// The same with other scales.
    #[must_use]
    pub fn scales(mut self, x: Scale, y: Scale) -> Self {
        (self.x.1, self.y.1) = (x, y);
        self
    }

    /// The same with another height, 260 being the usual one.
    #[must_use]
    pub fn height(mut self, height: f64) -> Self {
        self.height = height;
        self
    }

    /// The same, zoomed and panned together with all figures of this link.
    #[must_use]
    pub fn linked(mut self, link: &str) -> Self {
        self.link = Some(link.into());
        self
    }

    /// The same with a range along x that is shown at first, and alone in print.
    #[must_use]
    pub fn view(mut self, from: f64, to: f64) -> Self {
        self.view = Some((from, to));
        self
    }

    /// The same, shown whole in a strip above the first figure of its link.
    #[must_use]
    pub fn overview(mut self) -> Self {
        self.overview = true;
        self
    }

    /// Adds a line; an empty `label` keeps it out of the legend.
    #[must_use]
    pub fn line(self, role: Role, label: &str, points: Vec<(f64, f64)>) -> Self {
        self.item(Shape::Line(points), role, label)
    }

    /// Adds a line through the values of `points` minus those of `minus`, one for one.
    #[must_use]
    pub fn difference(
        self,
        role: Role,
        label: &str,
        points: Vec<(f64, f64)>,
        minus: Vec<f64>,
    ) -> Self {
        self.item(Shape::Difference(points, minus), role, label)
    }

    /// Adds a band between two values at every x.
    #[must_use]
    pub fn band(self, role: Role, label: &str, points: Vec<(f64, f64, f64)>) -> Self {
        self.item(Shape::Band(points), role, label)
    }

    /// Adds dots with bars of so much up and down.
    #[must_use]
    pub fn dots(self, role: Role, label: &str, points: Vec<(f64, f64, f64)>) -> Self {
        self.item(Shape::Dots(points), role, label)
    }

    /// Adds a level line.
    #[must_use]
    pub fn level(self, role: Role, label: &str, y: f64) -> Self {
        self.item(Shape::Level(y), role, label)
    }

    /// Adds an upright line.
    #[must_use]
    pub fn upright(self, role: Role, label: &str, x: f64) -> Self {
        self.item(Shape::Upright(x), role, label)
    }

    /// The same with its last item switched off at first.
    #[must_use]
    pub fn off(mut self) -> Self {
        if let Some(item) = self.items.last_mut() {
            item.off = true;
        }
        self
    }

    /// Whether there is nothing to draw.
    pub fn is_empty(&self) -> bool {
        self.items.iter().all(|item| match &item.shape {
            Shape::Line(points) | Shape::Difference(points, _) => points.is_empty(),
            Shape::Band(points) | Shape::Dots(points) => points.is_empty(),
            Shape::Level(_) | Shape::Upright(_) => true,
        })
    }

    fn item(mut self, shape: Shape, role: Role, label: &str) -> Self {
        self.items.push(Item { shape, role, label: label.into(), off: false });
        self
    }
}
