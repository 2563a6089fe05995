//! What to tell of frames whose error is not sure, or above their target.

use super::Session;
use crate::driver::ledger::FrameRecord;
use crate::driver::stopping::StoppedBy;
use crate::film::ErrorEstimate;
use crate::integrator::Integrator;

impl Session<'_> {
    /// What to tell of a frame whose error is not sure.
    pub(super) fn doubt(&self, record: &FrameRecord, estimate: Option<ErrorEstimate>) -> Option<String> {
        let doubt = estimate?.warning()?;
        let cure = match self.sampling.integrator {
            Integrator::Photon(_) | Integrator::Beams(_) => "more samples tell",
            _ => "more samples tell, and integrator = \"photon\" finds what chance does not",
        };
        Some(format!("frame {}: {doubt}; {cure}", record.frame))
    }

    /// What to tell of a frame that has all its samples and more error than it was to have.
    pub(super) fn missed(&self, record: &FrameRecord, estimate: Option<ErrorEstimate>) -> Option<String> {
        let target = self.settings.target_error.filter(|_| record.stopped_by == Some(StoppedBy::Samples))?;
        let samples = self.settings.samples;
        let Some(ErrorEstimate { relative, high, .. }) = estimate else {
            return Some(format!(
                "frame {}: with samples = {samples} its error is unknown; let it have 16 at least",
                record.frame
            ));
        };
        if high.is_infinite() {
            return Some(format!(
                "frame {}: its error is above the target of {} with all {samples} samples a pixel, and nobody can say \
                 by how much",
                record.frame,
                percent(target)
            ));
        }
        let cure = match samples_for(target, high, samples) {
            None => "so small a target takes more samples than floe can count".into(),
            Some(needed) => {
                // Radii that shrink keep some of the noise: photons need more.
                let is_shrinking = matches!(self.sampling.integrator, Integrator::Photon(_));
                let about = if is_shrinking { "no fewer than" } else { "about" };
                format!("{about} {needed} would do: write samples = {needed} into [render] of the scene file")
            }
        };
        (high > target).then(|| {
            format!(
                "frame {}: its error, {} (up to {}), is above the target of {} with all {samples} samples a pixel; {cure}",
                record.frame,
                percent(relative),
                percent(high),
                percent(target)
            )
        })
    }
}

/// Samples that bring an error down to a target, as the squared error falls while their number grows; `None` beyond what
/// may be asked for.
fn samples_for(target: f64, error: f64, samples: u32) -> Option<u32> {
    let needed = (f64::from(samples) * (error / target) * (error / target)).ceil();
    (needed <= f64::from(u32::MAX)).then_some(needed as u32)
}

/// Down to the smallest target, of 0.0001 %.
fn percent(part: f64) -> String {
    let digits = if part < 1e-4 { 5 } else { 3 };
    format!("{:.digits$} %", 100.0 * part)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_said_to_be_needed_may_be_asked_for() {
        assert_eq!(samples_for(0.01, 0.02, 64), Some(256));
        assert_eq!(samples_for(0.01, 0.010_000_01, 64), Some(65));
        assert_eq!(samples_for(1e-6, 0.5, 64), None);
    }
}
