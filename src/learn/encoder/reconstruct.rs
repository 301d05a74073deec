//! The state of a linear system from a window of outputs and inputs.

use nalgebra::{DMatrix, DVector};

use super::{EncoderError, SampledLinear, Window};

/// A linear map from a window to states: x = W [y; u] + bias, the window in the order of
/// [`Window`].
#[derive(Debug, Clone, PartialEq)]
pub struct LinearMap {
    /// W = [W_y W_u]: one row per state, one column per row of the window.
    pub weights: DMatrix<f64>,
    /// Constant part.
    pub bias: DVector<f64>,
}

/// A reconstructability map, with what it is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Reconstruction {
    /// The map.
    pub map: LinearMap,
    /// Rank of the observability matrix O: the number of states.
    pub rank: usize,
    /// Its largest singular value over its smallest, each state measured in the unit in
    /// which it shows most plainly.
    pub condition: f64,
}

/// Singular values below this share of the largest one count as 0.
const RANK: f64 = 1e-11;

/// The block matrices of one window, newest sample on top (Hoekstra et al., eq. `y_k_k+n`
/// and eq. `y_kn(noise)`), for inputs that a constant 1 is appended to.
pub(crate) struct Blocks {
    /// O: state at the oldest sample to outputs.
    pub observability: DMatrix<f64>,
    /// T: inputs to outputs.
    pub inputs: DMatrix<f64>,
    /// Lambda: outputs to later outputs, by the noise model; 0 without one.
    pub outputs: DMatrix<f64>,
    /// r: inputs to the state at k.
    pub to_state: DMatrix<f64>,
    /// lambda: outputs to the state at k, by the noise model.
    pub outputs_to_state: DMatrix<f64>,
    /// A^n, or (A - K C)^n.
    pub transition: DMatrix<f64>,
}

impl Blocks {
    /// For a window of `past` samples before k and, if `current`, sample k itself.
    pub fn of(linear: &SampledLinear, past: usize, current: bool) -> Self {
        let (n, nu, ny) = (linear.a.nrows(), linear.b.ncols(), linear.c.nrows());
        let samples = past + usize::from(current);
        // the constant parts are an input that is always 1
        let with = |m: &DMatrix<f64>, constant: &DVector<f64>| {
            let mut wide = m.clone().insert_column(nu, 0.0);
            wide.set_column(nu, constant);
            wide
        };
        let d = with(&linear.d, &linear.h);
        let none = DMatrix::zeros(n, ny);
        let k = linear.k.as_ref().unwrap_or(&none);
        // e = y - C x - D u put into the state equation, eq. `e_k`
        let a = &linear.a - k * &linear.c;
        let b = with(&linear.b, &linear.f) - k * &d;
        let mut powers = vec![DMatrix::identity(n, n)];
        for _ in 0..past {
            powers.push(&powers[powers.len() - 1] * &a);
        }
        let through: Vec<_> = powers.iter().map(|p| &linear.c * p).collect();
        let mut blocks = Self {
            observability: DMatrix::zeros(samples * ny, n),
            inputs: DMatrix::zeros(samples * ny, samples * (nu + 1)),
            outputs: DMatrix::zeros(samples * ny, samples * ny),
            to_state: DMatrix::zeros(n, samples * (nu + 1)),
            outputs_to_state: DMatrix::zeros(n, samples * ny),
            transition: powers[past].clone(),
        };
        // `time` counts samples from the oldest; rows and columns from the newest
        for time in 0..samples {
            let row = (samples - 1 - time) * ny;
            blocks.observability.view_mut((row, 0), (ny, n)).copy_from(&through[time]);
            for earlier in 0..=time {
                let column = samples - 1 - earlier;
                let mut from_u = blocks.inputs.view_mut((row, column * (nu + 1)), (ny, nu + 1));
                if earlier == time {
                    from_u.copy_from(&d);
                    continue;
                }
                let through = &through[time - earlier - 1];
                from_u.copy_from(&(through * &b));
                let mut from_y = blocks.outputs.view_mut((row, column * ny), (ny, ny));
                from_y.copy_from(&(through * k));
            }
            if time < past {
                let column = samples - 1 - time;
                let power = &powers[past - time - 1];
                let mut from_u = blocks.to_state.view_mut((0, column * (nu + 1)), (n, nu + 1));
                from_u.copy_from(&(power * &b));
                let mut from_y = blocks.outputs_to_state.view_mut((0, column * ny), (n, ny));
                from_y.copy_from(&(power * k));
            }
        }
        blocks
    }
}

impl Reconstruction {
    /// The map that gives the state of a linear system at k from a window; `names` are the
    /// states', for the error message.
    ///
    /// Without a noise model (Hoekstra et al., eq. `final_noiseless` and after it)
    ///
    /// ```text
    /// W_y = A^n O^+,   W_u = -A^n O^+ T + r,
    /// ```
    ///
    /// with it, in terms of A - K C and B - K D (eq. `noisy:final` and after it),
    ///
    /// ```text
    /// W_y = A^n O^+ (I - Lambda) + lambda,   W_u = -A^n O^+ T + r.
    /// ```
    ///
    /// O^+ is the Moore-Penrose left inverse. Constants of an affine system go into the
    /// bias. Without the current sample, O, T and Lambda end at sample k - 1. Where n_a and
    /// n_b differ, the shorter of the two is used and older samples of the other have
    /// weight 0.
    ///
    /// ```
    /// use lacuna::encoder::{Reconstruction, SampledLinear, Window};
    /// use nalgebra::{dmatrix, dvector};
    ///
    /// // position and speed: the speed shows one sample later
    /// let cart = SampledLinear {
    ///     a: dmatrix![1.0, 0.1; 0.0, 1.0],
    ///     b: dmatrix![0.0; 0.1],
    ///     f: dvector![0.0, 0.0],
    ///     c: dmatrix![1.0, 0.0],
    ///     d: dmatrix![0.0],
    ///     h: dvector![0.0],
    ///     k: None,
    /// };
    /// let names = ["position".into(), "speed".into()];
    /// let found = Reconstruction::of(&cart, Window::past(2), &names)?;
    /// // y_{k-1} = 1.2, y_{k-2} = 1.0, u_{k-1} = u_{k-2} = 0: two metres a second
    /// let x = &found.map.weights * dvector![1.2, 1.0, 0.0, 0.0] + &found.map.bias;
    /// assert!((x - dvector![1.4, 2.0]).amax() < 1e-12);
    /// // one sample does not tell the speed
    /// let error = Reconstruction::of(&cart, Window::past(1), &names).unwrap_err();
    /// assert!(error.to_string().contains("`speed`"));
    /// # Ok::<(), lacuna::encoder::EncoderError>(())
    /// ```
    ///
    /// What the outputs do not fix may be left open where the window is long enough to forget
    /// it: x_k is determined where A^n x = 0 for every x with O x = 0 (reconstructability;
    /// Kailath, *Linear Systems*, sec. 6.2), as it is for the past of a delay.
    ///
    /// # Errors
    ///
    /// [`EncoderError::Unobservable`] with the states that the outputs do not fix.
    pub fn of(
        linear: &SampledLinear,
        window: Window,
        names: &[String],
    ) -> Result<Self, EncoderError> {
        Self::resting(linear, window, names, |_| false).map(|(found, _)| found)
    }

    /// The same, with those states that the outputs do not fix and that `may_rest` holds for
    /// taken to be 0 at the oldest sample; these are given too.
    pub(crate) fn resting(
        linear: &SampledLinear,
        window: Window,
        names: &[String],
        may_rest: impl Fn(usize) -> bool,
    ) -> Result<(Self, Vec<usize>), EncoderError> {
        let (n, nu, ny) = (linear.a.nrows(), linear.b.ncols(), linear.c.nrows());
        let past = if nu == 0 { window.n_a } else { window.n_a.min(window.n_b) };
        let current = window.current_sample;
        let samples = past + usize::from(current);
        let blocks = Blocks::of(linear, past, current);
        let mut rest = vec![];
        let inverse = loop {
            let mut seen = blocks.observability.clone();
            rest.iter().for_each(|&state| seen.column_mut(state).fill(0.0));
            let mut forgets = blocks.transition.clone();
            rest.iter().for_each(|&state| forgets.column_mut(state).fill(0.0));
            let hidden = match left_inverse(&seen, &forgets) {
                Ok(inverse) => break inverse,
                Err(hidden) => hidden,
            };
            let still = |state: &usize| may_rest(*state) && !rest.contains(state);
            let more: Vec<usize> = hidden.states.iter().copied().filter(still).collect();
            if more.is_empty() {
                let named =
                    |&i: &usize| names.get(i).cloned().unwrap_or_else(|| format!("x{}", i + 1));
                let rank = n - hidden.deficiency;
                let hidden = hidden.states.iter().map(named).collect();
                return Err(EncoderError::Unobservable { hidden, rank, states: n, samples });
            }
            rest.extend(more);
        };
        let back = &blocks.transition * inverse.matrix;
        let identity = DMatrix::identity(samples * ny, samples * ny);
        let w_y = &back * (identity - blocks.outputs) + blocks.outputs_to_state;
        let w_u = blocks.to_state - back * blocks.inputs;
        let mut weights = DMatrix::zeros(n, window.rows(ny, nu));
        weights.view_mut((0, 0), (n, samples * ny)).copy_from(&w_y);
        let mut bias = DVector::zeros(n);
        let first = window.outputs() * ny;
        for s in 0..samples {
            let own = w_u.columns(s * (nu + 1), nu + 1);
            weights.view_mut((0, first + s * nu), (n, nu)).copy_from(&own.columns(0, nu));
            bias += own.column(nu);
        }
        let map = LinearMap { weights, bias };
        let rank = inverse.rank;
        Ok((Self { map, rank, condition: inverse.condition }, rest))
    }
}

/// A left inverse and how well it is determined.
struct LeftInverse {
    matrix: DMatrix<f64>,
    rank: usize,
    condition: f64,
}

/// Columns that a matrix does not tell apart from others or from nothing.
struct Hidden {
    states: Vec<usize>,
    deficiency: usize,
}

/// The Moore-Penrose inverse of a matrix that tells apart everything that `forgets` does not
/// take to 0. Columns are brought to length 1 first, which lets units of states differ (and does
/// not change the inverse where the rank is full).
fn left_inverse(matrix: &DMatrix<f64>, forgets: &DMatrix<f64>) -> Result<LeftInverse, Hidden> {
    let n = matrix.ncols();
    if n == 0 {
        let matrix = DMatrix::zeros(0, matrix.nrows());
        return Ok(LeftInverse { matrix, rank: 0, condition: 1.0 });
    }
    let lengths: Vec<f64> = matrix.column_iter().map(|c| c.norm()).collect();
    let longest = lengths.iter().fold(0.0, |most: f64, &l| most.max(l));
    let silent = |length: f64| length <= f64::MIN_POSITIVE.max(1e-200 * longest);
    let lengths: Vec<f64> =
        lengths.into_iter().map(|length| if silent(length) { 1.0 } else { length }).collect();
    let mut scaled = matrix.clone();
    for (mut column, &length) in scaled.column_iter_mut().zip(&lengths) {
        column /= length;
    }
    // at least as many rows as columns, so that all right singular vectors are there
    let rows = scaled.nrows().max(n);
    let missing = rows - scaled.nrows();
    let padded = scaled.insert_rows(matrix.nrows(), missing, 0.0);
    let svd = padded.svd(true, true);
    let (Some(u), Some(v_t)) = (&svd.u, &svd.v_t) else {
        return Err(Hidden { states: (0..n).collect(), deficiency: n });
    };
    let largest = svd.singular_values.max();
    let lost: Vec<usize> =
        (0..n).filter(|&i| svd.singular_values[i] <= RANK * largest || largest == 0.0).collect();
    // what remains at the end of the window of a direction that no output shows
    let remains = |i: usize| {
        let along = DVector::from_fn(n, |state, _| v_t[(i, state)] / lengths[state]);
        (forgets * &along).norm() > 1e-9 * along.norm()
    };
    if lost.iter().any(|&i| remains(i)) {
        let unseen = |state: &usize| {
            lost.iter().map(|&i| v_t[(i, *state)].powi(2)).sum::<f64>().sqrt() > 1e-6
        };
        return Err(Hidden { states: (0..n).filter(unseen).collect(), deficiency: lost.len() });
    }
    let mut inverse = v_t.transpose();
    for i in 0..n {
        let part = if lost.contains(&i) { 0.0 } else { 1.0 / svd.singular_values[i] };
        inverse.column_mut(i).scale_mut(part);
    }
    let mut inverse = inverse * u.transpose();
    for (i, &length) in lengths.iter().enumerate() {
        inverse.row_mut(i).scale_mut(1.0 / length);
    }
    let kept = (0..n).filter(|i| !lost.contains(i)).map(|i| svd.singular_values[i]);
    let condition = largest / kept.fold(largest, f64::min);
    let rank = n - lost.len();
    Ok(LeftInverse { matrix: inverse.columns(0, matrix.nrows()).into_owned(), rank, condition })
}
