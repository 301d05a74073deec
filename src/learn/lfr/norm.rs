//! Bounds on how strongly a network answers: products of spectral norms.
//!
//! ```text
//! |phi(z) - phi(z')| <= L |z - z'|,   L = ||W_l|| + ||W_o|| ||W_m|| .. ||W_2|| ||W_1||
//! ```
//!
//! for units of slope at most 1, such as tanh (Szegedy et al., *Intriguing properties of neural
//! networks*, 2014, sec. 4.3), with the columns of the inputs and the rows of the outputs that count.

use nalgebra::DMatrix;

use crate::network::Layout;

/// Some entries of the vector of parameters as a matrix.
#[derive(Debug, Clone)]
pub(super) struct Part {
    /// Positions of the entries, row after row.
    at: Vec<usize>,
    rows: usize,
    cols: usize,
}

impl Part {
    /// Rows and columns of a matrix of `width` columns that begins at `first`.
    pub fn of(first: usize, width: usize, rows: &[usize], cols: &[usize]) -> Self {
        let at = rows.iter().flat_map(|r| cols.iter().map(move |c| first + r * width + c));
        Self { at: at.collect(), rows: rows.len(), cols: cols.len() }
    }

    /// The spectral norm and its slope along every entry.
    fn norm(&self, parameters: &[f64]) -> (f64, Vec<f64>) {
        let values: Vec<f64> = self.at.iter().map(|&at| parameters[at]).collect();
        spectral(&DMatrix::from_row_slice(self.rows, self.cols, &values))
    }
}

/// The largest singular value, and its slope along every entry, row after row: u v'.
pub(super) fn spectral(matrix: &DMatrix<f64>) -> (f64, Vec<f64>) {
    let (rows, cols) = matrix.shape();
    let svd = matrix.clone().svd(true, true);
    let (Some(u), Some(v)) = (&svd.u, &svd.v_t) else {
        return (f64::INFINITY, vec![0.0; rows * cols]);
    };
    let Some(top) = (0..svd.singular_values.len())
        .max_by(|&i, &j| svd.singular_values[i].total_cmp(&svd.singular_values[j]))
    else {
        return (0.0, vec![]);
    };
    let slopes = (0..rows).flat_map(|i| (0..cols).map(move |j| (i, j)));
    let slopes = slopes.map(|(i, j)| u[(i, top)] * v[(top, j)]).collect();
    (svd.singular_values[top], slopes)
}

/// The bound on a network from some of its inputs to some of its outputs.
#[derive(Debug, Clone)]
pub(super) struct Bound {
    /// The linear part.
    linear: Part,
    /// The layers from the first to the output's.
    layers: Vec<Part>,
}

impl Bound {
    /// Of a network whose weights begin at `first`.
    pub fn of(layout: &Layout, first: usize, inputs: &[usize], outputs: &[usize]) -> Self {
        let all = |count: usize| (0..count).collect::<Vec<usize>>();
        let linear = Part::of(first + layout.linear().start, layout.inputs(), outputs, inputs);
        let mut layers = vec![];
        let hidden = layout.hidden();
        for (i, &units) in hidden.iter().enumerate() {
            let Some((rows, _)) = layout.hidden_layer(i) else { break };
            let width = if i == 0 { layout.inputs() } else { hidden[i - 1] };
            let cols = if i == 0 { inputs.to_vec() } else { all(width) };
            layers.push(Part::of(first + rows.start, width, &all(units), &cols));
        }
        if let Some(&last) = hidden.last() {
            layers.push(Part::of(first + layout.output().start, last, outputs, &all(last)));
        }
        Self { linear, layers }
    }

    /// The entries that the bound is proportional to.
    pub fn scaled(&self) -> impl Iterator<Item = usize> + '_ {
        self.linear.at.iter().chain(self.layers.first().into_iter().flat_map(|l| &l.at)).copied()
    }

    /// The bound, and its slopes along entries.
    pub fn value(&self, parameters: &[f64]) -> (f64, Vec<(usize, f64)>) {
        let (linear, along) = self.linear.norm(parameters);
        let mut slopes: Vec<(usize, f64)> = self.linear.at.iter().copied().zip(along).collect();
        let norms: Vec<_> = self.layers.iter().map(|layer| layer.norm(parameters)).collect();
        let product = |without: Option<usize>| -> f64 {
            let factors = norms.iter().enumerate().filter(|(i, _)| Some(*i) != without);
            factors.map(|(_, (norm, _))| norm).product()
        };
        for (i, layer) in self.layers.iter().enumerate() {
            let rest = product(Some(i));
            slopes.extend(layer.at.iter().zip(&norms[i].1).map(|(&at, slope)| (at, rest * slope)));
        }
        let through = if self.layers.is_empty() { 0.0 } else { product(None) };
        (linear + through, slopes)
    }
}
