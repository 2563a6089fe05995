//! Two media side by side.

use super::quantity::QUANTITIES;
use super::{MediumReport, text_of};

/// Two reports on the same wavelengths.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// What the other is compared with.
    pub a: MediumReport,
    /// The other.
    pub b: MediumReport,
}

impl Comparison {
    /// Both reports, and what each quantity of B is over that of A; null where A has none.
    pub fn json(&self, with_phase: bool) -> String {
        let ratios = QUANTITIES.iter().map(|quantity| {
            let [a, b] = [&self.a, &self.b].map(|report| (quantity.values)(report));
            let ratios: Vec<f64> = a.iter().zip(b).map(|(a, b)| b / a).collect();
            (quantity.key.to_owned(), serde_json::json!(ratios))
        });
        let ratios: serde_json::Map<_, _> = ratios.collect();
        let [a, b] = [&self.a, &self.b].map(|report| report.value(with_phase));
        text_of(&serde_json::json!({ "a": a, "b": b, "b_over_a": ratios }))
    }
}
