//! Random numbers of fixed seeds and the distribution of chi-square.

/// Steele, Lea and Flood's SplitMix64.
#[derive(Clone, Debug)]
pub struct SplitMix(pub u64);

impl SplitMix {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1), with the 24 bits of an f32.
    pub fn f32(&mut self) -> f32 {
        (self.next() >> 40) as f32 * (1.0 / 16_777_216.0)
    }

    pub fn f64(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn pair(&mut self) -> [f32; 2] {
        [self.f32(), self.f32()]
    }
}

/// Probability that chi-square with `degrees` of freedom exceeds `x`: the regularised upper gamma function Q(k/2, x/2),
/// by its series below the mean and Lentz's continued fraction above.
pub fn chi_square_tail(x: f64, degrees: usize) -> f64 {
    let (a, x) = (0.5 * degrees as f64, 0.5 * x);
    if x <= 0.0 {
        return 1.0;
    }
    let prefactor = (a * x.ln() - x - libm::lgamma(a)).exp();
    if x < a + 1.0 {
        let (mut term, mut sum, mut n) = (1.0 / a, 1.0 / a, a);
        while term > sum * 1e-15 {
            n += 1.0;
            term *= x / n;
            sum += term;
        }
        return 1.0 - prefactor * sum;
    }
    let mut b = x + 1.0 - a;
    let mut c = 1e300;
    let mut d = 1.0 / b;
    let mut fraction = d;
    for i in 1..10_000 {
        let an = -f64::from(i) * (f64::from(i) - a);
        b += 2.0;
        d = 1.0 / (an * d + b);
        c = b + an / c;
        fraction *= d * c;
        if (d * c - 1.0).abs() < 1e-15 {
            break;
        }
    }
    prefactor * fraction
}

/// The p-value of counts against expected ones; cells that expect fewer than five are joined to their neighbours.
pub fn chi_square_p(observed: &[u64], expected: &[f64]) -> f64 {
    let (mut statistic, mut cells, mut o, mut e) = (0.0, 0_usize, 0.0, 0.0);
    for (count, expectation) in observed.iter().zip(expected) {
        o += *count as f64;
        e += expectation;
        if e >= 5.0 {
            statistic += (o - e) * (o - e) / e;
            cells += 1;
            (o, e) = (0.0, 0.0);
        }
    }
    // What is left over has no cell of its own; events where none are expected are never excused.
    if e > 0.0 || o > 0.0 {
        statistic += (o - e) * (o - e) / e.max(1e-12);
        cells += 1;
    }
    chi_square_tail(statistic, cells.saturating_sub(1).max(1))
}
