//! Figures as the page carries them: charts that name their columns by number.

use serde::{Deserialize, Serialize};

use super::column::{Columns, Stored};
use super::escape::plain;
use super::figure::{Figure, Item, Role, Scale, Shape};
use super::thin::thinned;

/// Lines shorter than this are never thinned.
const LONG: usize = 2000;

/// An axis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Axis {
    label: String,
    scale: Scale,
    /// What stands at 1, 2, .. instead of numbers.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    names: Vec<String>,
}

/// How an item is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Kind {
    Line,
    Band,
    Dots,
    Level,
    Upright,
}

/// One thing in a chart. A line has `x`, `y` and perhaps `minus`, which is taken from `y`;
/// a band `x`, `y` (low) and `z` (high); dots `x`, `y` and `z` (half the bar); level and upright
/// lines have `at`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Part {
    kind: Kind,
    role: Role,
    #[serde(default, skip_serializing_if = "String::is_empty")]
    label: String,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    off: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    x: Option<usize>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    y: Option<usize>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    minus: Option<usize>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    z: Option<usize>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    at: Option<f64>,
}

/// A figure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Chart {
    title: String,
    height: f64,
    x: Axis,
    y: Axis,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    link: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    view: Option<(f64, f64)>,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    overview: bool,
    /// Samples that stand behind one pair of smallest and largest value, where lines are too
    /// long to be carried whole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    thinned: Option<usize>,
    items: Vec<Part>,
}

/// All figures of a page with their columns.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Charts {
    columns: Vec<Stored>,
    charts: Vec<Chart>,
}

impl Charts {
    /// Packs figures; long lines are thinned where they would make the page too large.
    pub fn of(figures: &[Figure]) -> Self {
        let mut columns = Columns::default();
        let charts = figures.iter().map(|figure| chart(figure, &mut columns, None)).collect();
        let excess = columns.excess();
        if excess <= 1.0 {
            return Self { columns: columns.stored(), charts };
        }
        // differences become lines of their own when they are thinned, at most two for one
        let longest = figures.iter().flat_map(|f| &f.items).filter_map(|i| i.shape.points());
        let longest = longest.map(|points| points.len()).max().unwrap_or(0) as f64;
        let mut stretches = (longest / (2.0 * excess)) as usize;
        loop {
            let mut columns = Columns::default();
            let pack = |figure| chart(figure, &mut columns, Some(stretches));
            let charts = figures.iter().map(pack).collect();
            if columns.excess() <= 1.0 || stretches <= LONG / 2 {
                return Self { columns: columns.stored(), charts };
            }
            stretches = stretches * 2 / 3;
        }
    }

    /// The figures; `None` where a stored form is damaged.
    pub fn figures(&self) -> Option<Vec<Figure>> {
        let columns: Option<Vec<Vec<f64>>> = self.columns.iter().map(Stored::values).collect();
        let columns = columns?;
        self.charts.iter().map(|chart| figure(chart, &columns)).collect()
    }
}

fn chart(figure: &Figure, columns: &mut Columns, stretches: Option<usize>) -> Chart {
    let mut kept = None;
    let items = figure.items.iter().map(|item| {
        let thin = stretches
            .filter(|s| item.shape.points().is_some_and(|p| p.len() > LONG && p.len() > 2 * s));
        match (thin, item.shape.points()) {
            (Some(stretches), Some(points)) => {
                kept = Some(points.len().div_ceil(stretches));
                let short =
                    Item { shape: Shape::Line(thinned(&points, stretches)), ..item.clone() };
                part(&short, columns)
            }
            _ => part(item, columns),
        }
    });
    let items = items.collect();
    let axis = |(label, scale): &(String, Scale), names: &[String]| Axis {
        label: plain(label),
        scale: *scale,
        names: names.iter().map(|name| plain(name)).collect(),
    };
    Chart {
        title: plain(&figure.title),
        height: figure.height,
        x: axis(&figure.x, &figure.names),
        y: axis(&figure.y, &[]),
        link: figure.link.clone(),
        view: figure.view,
        overview: figure.overview,
        thinned: kept,
        items,
    }
}

fn part(item: &Item, columns: &mut Columns) -> Part {
    let (kind, at) = match item.shape {
        Shape::Line(_) | Shape::Difference(..) => (Kind::Line, None),
        Shape::Band(_) => (Kind::Band, None),
        Shape::Dots(_) => (Kind::Dots, None),
        Shape::Level(at) => (Kind::Level, Some(at)),
        Shape::Upright(at) => (Kind::Upright, Some(at)),
    };
    let (mut x, mut y, mut minus, mut z) = (None, None, None, None);
    match &item.shape {
        Shape::Line(points) | Shape::Difference(points, _) => {
            x = Some(columns.add(points.iter().map(|p| p.0).collect()));
            y = Some(columns.add(points.iter().map(|p| p.1).collect()));
            if let Shape::Difference(_, values) = &item.shape {
                minus = Some(columns.add(values.clone()));
            }
        }
        Shape::Band(points) | Shape::Dots(points) => {
            x = Some(columns.add(points.iter().map(|p| p.0).collect()));
            y = Some(columns.add(points.iter().map(|p| p.1).collect()));
            z = Some(columns.add(points.iter().map(|p| p.2).collect()));
        }
        Shape::Level(_) | Shape::Upright(_) => {}
    }
    let (role, label, off) = (item.role, plain(&item.label), item.off);
    Part { kind, role, label, off, x, y, minus, z, at }
}

fn figure(chart: &Chart, columns: &[Vec<f64>]) -> Option<Figure> {
    let items: Option<Vec<Item>> = chart.items.iter().map(|part| item(part, columns)).collect();
    Some(Figure {
        title: chart.title.clone(),
        x: (chart.x.label.clone(), chart.x.scale),
        y: (chart.y.label.clone(), chart.y.scale),
        height: chart.height.clamp(60.0, 2000.0),
        items: items?,
        names: chart.x.names.clone(),
        link: chart.link.clone(),
        view: chart.view,
        overview: chart.overview,
    })
}

fn item(part: &Part, columns: &[Vec<f64>]) -> Option<Item> {
    let column = |number: Option<usize>| columns.get(number?);
    let pairs = || Some((column(part.x)?, column(part.y)?));
    let points = || -> Option<Vec<(f64, f64)>> {
        let (x, y) = pairs()?;
        Some(x.iter().copied().zip(y.iter().copied()).collect())
    };
    let triples = || -> Option<Vec<(f64, f64, f64)>> {
        let ((x, y), z) = (pairs()?, column(part.z)?);
        Some(x.iter().zip(y).zip(z).map(|((x, y), z)| (*x, *y, *z)).collect())
    };
    let shape = match part.kind {
        Kind::Line if part.minus.is_some() => {
            Shape::Difference(points()?, column(part.minus)?.clone())
        }
        Kind::Line => Shape::Line(points()?),
        Kind::Band => Shape::Band(triples()?),
        Kind::Dots => Shape::Dots(triples()?),
        Kind::Level => Shape::Level(part.at?),
        Kind::Upright => Shape::Upright(part.at?),
    };
    Some(Item { shape, role: part.role, label: part.label.clone(), off: part.off })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(n: u32) -> Vec<Figure> {
        let at = |k: u32| f64::from(k) * 0.01;
        let y: Vec<(f64, f64)> = (0..n).map(|k| (at(k), (7.0 * at(k) * at(k)).sin())).collect();
        let r: Vec<f64> =
            (0..n).map(|k| 1e-3 * (u64::from(k).pow(2) % 977) as f64 / 977.0).collect();
        let residual = y.iter().zip(&r).map(|(p, r)| (p.0, *r)).collect();
        let signal = Figure::new("time [s]", "y [m]").line(Role::Measured, "measured", y.clone());
        vec![
            signal.difference(Role::Before, "model", y, r).view(1.0, 2.0).linked("time"),
            Figure::new("time [s]", "residual").line(Role::Before, "model", residual).overview(),
            Figure::new("z", "w")
                .dots(Role::Free, "", vec![(1.0, 2.0, 0.5)])
                .band(Role::Floor, "band", vec![(0.0, -1.0, 1.0), (2.0, -1.0, 1.0)])
                .level(Role::Floor, "floor", 0.25)
                .upright(Role::Quiet, "", 1.5)
                .off(),
        ]
    }

    #[test]
    fn figures_come_back_from_what_is_stored() {
        let figures = record(3000);
        let stored = serde_json::to_string(&Charts::of(&figures)).unwrap();
        let charts: Charts = serde_json::from_str(&stored).unwrap();
        let back = charts.figures().unwrap();
        assert_eq!(back.len(), 3);
        assert_eq!(back[2], figures[2]);
        let (a, b) =
            (back[0].items[1].shape.points().unwrap(), figures[0].items[1].shape.points().unwrap());
        let worst = a.iter().zip(b.iter()).map(|(a, b)| (a.1 - b.1).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-6, "{worst}");
        // and packing them again changes nothing
        assert_eq!(serde_json::to_string(&Charts::of(&back)).unwrap(), stored);
    }

    #[test]
    fn a_record_of_any_length_keeps_the_page_small() {
        for n in [100_000, 2_000_000] {
            let charts = Charts::of(&record(n));
            let size = serde_json::to_string(&charts).unwrap().len();
            assert!(size < 1_500_000, "{n}: {size}");
            assert_eq!(charts.charts[0].thinned.is_some(), n > 1_000_000);
        }
    }

    #[test]
    fn damaged_charts_are_refused() {
        let mut charts = Charts::of(&record(10));
        charts.charts[0].items[0].y = Some(99);
        assert_eq!(charts.figures(), None);
    }
}
