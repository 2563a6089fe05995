use proptest::prelude::*;

use super::*;

fn sum_of(addends: impl IntoIterator<Item = f32>) -> ExactSums {
    let mut sums = ExactSums::default();
    for addend in addends {
        sums.add(7, [addend]);
    }
    sums
}

/// Finite numbers of every exponent, and such as cancel.
fn any_addends() -> impl Strategy<Value = Vec<f32>> {
    let one = any::<u32>().prop_map(f32::from_bits).prop_filter("finite", |x| x.is_finite());
    prop::collection::vec(one, 0..40).prop_flat_map(|some| {
        let negated: Vec<f32> = some.iter().skip(some.len() / 2).map(|x| -x).collect();
        Just([some, negated].concat()).prop_shuffle()
    })
}

#[test]
fn what_rounding_takes_away_comes_back() {
    let [huge, tiny] = [f32::MAX, f32::from_bits(1)];
    for (addends, exact) in [
        (vec![1.0, 1e-20, -1.0], f64::from(1e-20_f32)),
        (vec![huge, tiny, -huge], f64::from(tiny)),
        (vec![huge, -tiny, -huge, 1.0], 1.0),
        (vec![tiny, huge, -tiny, -huge], 0.0),
        (vec![], 0.0),
        (vec![-0.0], 0.0),
        // Half of the last digit of 1 to even, and a trace more to above.
        (vec![1.0, 2.0_f32.powi(-53)], 1.0),
        (vec![1.0, 2.0_f32.powi(-53), tiny], 1.0 + f64::EPSILON),
        (vec![-1.0, -2.0_f32.powi(-53), -tiny], -1.0 - f64::EPSILON),
        (vec![huge; 1 << 12], f64::from(huge) * 4096.0),
    ] {
        let value = sum_of(addends.iter().copied()).values()[7];
        assert_eq!(value.to_bits(), exact.to_bits(), "{:?}: {value:e}", &addends[..addends.len().min(5)]);
    }
}

#[test]
fn sums_side_by_side_do_not_mix() {
    let mut sums = ExactSums::default();
    sums.add(3, [1.0, 2.0, 3.0]);
    sums.add(4, [1e-30, 1e30]);
    sums.add(4, [-2.0, -1e30]);
    let values = sums.values();
    assert_eq!((values[3], values[4], values[5]), (1.0, f64::from(1e-30_f32), 3.0));
    assert_eq!(values.iter().filter(|value| **value != 0.0).count(), 3);
}

/// Whatever a file holds.
#[test]
fn units_without_a_place_do_no_harm() {
    for value in [f64::NAN, f64::INFINITY, f64::MAX, -f64::MAX, f64::MIN_POSITIVE, 5e-324, 1e100] {
        for limbs in [[0; LIMBS], [u64::MAX; LIMBS], [0, 0, 0, 0, 1 << 63]] {
            let mut sums = ExactSums { rounded: [value; SUMS], rests: Vec::new() };
            sums.rests = vec![Rest { of: 3, units: Units(limbs) }, Rest { of: 255, units: Units(limbs) }];
            let other = sums.clone();
            sums += &other;
            let _ = sums.values();
        }
    }
}

proptest! {
    #[test]
    fn no_order_and_no_grouping_changes_a_bit(addends in any_addends(), seed in any::<u64>(), cuts in 1..6_usize) {
        let value = sum_of(addends.iter().copied()).values()[7];
        let mut shuffled = addends.clone();
        shuffled.sort_by_key(|x| u64::from(x.to_bits()).wrapping_add(1).wrapping_mul(seed | 1));
        let mut grouped = ExactSums::default();
        for group in shuffled.chunks(addends.len() / cuts + 1) {
            grouped += &sum_of(group.iter().copied());
        }
        prop_assert_eq!(grouped.values()[7].to_bits(), value.to_bits());
    }

    /// Where nothing is rounded, plain addition is right.
    #[test]
    fn small_integers_are_added_as_ever(addends in prop::collection::vec(-1000_i16..1000, 0..50)) {
        let plain: i64 = addends.iter().map(|&x| i64::from(x)).sum();
        let sums = sum_of(addends.iter().map(|&x| x.into()));
        prop_assert!(sums.rests.is_empty());
        prop_assert_eq!(sums.values()[7], plain as f64);
    }
}
