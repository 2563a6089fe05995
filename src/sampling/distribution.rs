//! Tabulated distributions: pick an entry, or a point of a picture, in proportion to its value.

/// Entries picked in proportion to non-negative weights.
#[derive(Clone, Debug)]
pub struct Distribution1d {
    /// Running sums, first 0 and last the total.
    cumulative: Vec<f64>,
}

impl Distribution1d {
    /// Weights must be finite and not negative; `None` when they sum to zero.
    pub fn new(weights: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut cumulative = vec![0.0];
        let mut sum = 0.0;
        for weight in weights {
            sum += weight;
            cumulative.push(sum);
        }
        (sum > 0.0 && sum.is_finite()).then_some(Self { cumulative })
    }

    /// Number of entries.
    pub fn len(&self) -> usize {
        self.cumulative.len() - 1
    }

    /// Never: an empty distribution cannot be made.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Sum of the weights.
    pub fn total(&self) -> f64 {
        self.cumulative[self.len()]
    }

    /// Probability of an entry.
    pub fn probability(&self, index: usize) -> f32 {
        ((self.cumulative[index + 1] - self.cumulative[index]) / self.total()) as f32
    }

    /// The entry at `u` in [0, 1), and where in its share u lies, in [0, 1).
    pub fn sample(&self, u: f32) -> (usize, f32) {
        let target = f64::from(u) * self.total();
        // The last running sum at or below the target starts the entry; entries of weight zero are stepped over.
        let index = self.cumulative.partition_point(|&c| c <= target).clamp(1, self.len()) - 1;
        let width = self.cumulative[index + 1] - self.cumulative[index];
        let rest = (target - self.cumulative[index]) / width;
        (index, (rest as f32).clamp(0.0, 1.0 - f32::EPSILON * 0.5))
    }
}

/// Points of the unit square picked in proportion to a picture's cells.
#[derive(Clone, Debug)]
pub struct Distribution2d {
    rows: Distribution1d,
    columns: Vec<Option<Distribution1d>>,
}

impl Distribution2d {
    /// `weights` row by row, `width` a row; `None` when all are zero.
    pub fn new(width: usize, weights: &[f64]) -> Option<Self> {
        let columns: Vec<_> =
            weights.chunks_exact(width).map(|row| Distribution1d::new(row.iter().copied())).collect();
        let rows =
            Distribution1d::new(columns.iter().map(|c| c.as_ref().map_or(0.0, Distribution1d::total)))?;
        Some(Self { rows, columns })
    }

    /// A point (x, y) in [0, 1)^2 and its density over the square.
    pub fn sample(&self, u: [f32; 2]) -> ([f32; 2], f32) {
        let (row, y) = self.rows.sample(u[1]);
        let Some(columns) = &self.columns[row] else {
            return ([0.0; 2], 0.0);
        };
        let (column, x) = columns.sample(u[0]);
        let point = [(column as f32 + x) / columns.len() as f32, (row as f32 + y) / self.rows.len() as f32];
        (point, self.density(row, column))
    }

    /// Density over the unit square at a point of it.
    pub fn pdf(&self, point: [f32; 2]) -> f32 {
        let row = cell(point[1], self.rows.len());
        self.columns[row].as_ref().map_or(0.0, |c| self.density(row, cell(point[0], c.len())))
    }

    fn density(&self, row: usize, column: usize) -> f32 {
        self.columns[row].as_ref().map_or(0.0, |columns| {
            let cells = (columns.len() * self.rows.len()) as f32;
            self.rows.probability(row) * columns.probability(column) * cells
        })
    }
}

fn cell(x: f32, n: usize) -> usize {
    ((x * n as f32) as usize).min(n - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_come_in_proportion_and_never_with_weight_zero() {
        let d = Distribution1d::new([0.0, 1.0, 0.0, 3.0, 0.0]).unwrap();
        let mut counts = [0; 5];
        for i in 0..4000 {
            let (index, rest) = d.sample(i as f32 / 4000.0);
            counts[index] += 1;
            assert!((0.0..1.0).contains(&rest));
        }
        assert_eq!(counts, [0, 1000, 0, 3000, 0]);
        assert_eq!(d.sample(1.0 - f32::EPSILON * 0.5).0, 3);
        assert_eq!((d.probability(1), d.probability(3), d.probability(0)), (0.25, 0.75, 0.0));
        assert!(Distribution1d::new([0.0, 0.0]).is_none() && Distribution1d::new([]).is_none());
    }

    #[test]
    fn a_picture_is_sampled_with_the_density_it_states() {
        let weights = [1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 4.0, 0.0, 1.0];
        let d = Distribution2d::new(3, &weights).unwrap();
        let n = 300;
        let mut counts = [0.0; 9];
        for i in 0..n * n {
            let u = [((i % n) as f32 + 0.5) / n as f32, ((i / n) as f32 + 0.5) / n as f32];
            let (point, density) = d.sample(u);
            assert_eq!(density, d.pdf(point));
            counts[cell(point[1], 3) * 3 + cell(point[0], 3)] += 1.0;
        }
        for (count, weight) in counts.iter().zip(weights) {
            // Midpoints of a grid of 300 can miss a share by one column or row in 300.
            assert!((count / (n * n) as f64 - weight / 8.0).abs() < 0.01);
        }
    }
}
