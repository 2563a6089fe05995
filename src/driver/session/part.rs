//! Some of a frame's samples as a partial, and the partials of a frame as its picture.

use super::{Drawn, Session};
use crate::driver::accumulation::Accumulation;
use crate::driver::ahead::{Preparation, Ready, timed};
use crate::driver::checkpoint::Checkpoint;
use crate::driver::error::RenderError;
use crate::driver::job::FrameTask;
use crate::driver::ledger::{FrameRecord, Status};
use crate::driver::partial::{self, Took, Wanted};
use crate::driver::parts::{Merged, merged, remove_partials};
use crate::driver::samples_range::SamplesRange;
use crate::driver::stopping::StoppedBy;
use crate::film::FrameImage;

impl Session<'_> {
    /// Draws some samples of a frame and writes their sums. The picture that they alone would make.
    pub(super) fn some_samples(
        &mut self,
        task: &FrameTask,
        ready: &Ready,
        range: SamplesRange,
        record: &mut FrameRecord,
    ) -> Result<FrameImage, RenderError> {
        record.output = range.partial_of(&record.output);
        let frame = &ready.assembled.frame;
        let wanted = self.wanted(task, ready);
        let checkpoint = Checkpoint::of(&record.output, wanted.fingerprint.of_range(range));
        let mut sums = Accumulation::of_range(wanted.resolution, range.first);
        let mut seconds = 0.0;
        let draw = |session: &Self| {
            let (stopped_by, keeper) = session.go_on(&mut sums, frame, Some(&checkpoint))?;
            seconds = keeper.seconds();
            let (image, counters) = sums.so_far();
            Ok(Drawn { image, counters, beams: keeper.beams(), stopped_by, dropped: 0 })
        };
        let traced = self.trace(task, &ready.assembled, false, record, draw);
        if let Err(RenderError::Mismatches { .. }) = traced {
            checkpoint.remove();
        }
        let image = traced?;
        let took = Took::of(seconds, record.render_seconds, record.threads);
        let write = || partial::write(&record.output, &wanted.label(range), &sums, record.beams, took);
        timed(&mut record.write_seconds, || self.options.interrupt.while_writing(write))?;
        checkpoint.remove();
        Ok(image)
    }

    /// Makes the picture of a frame from its partials, and removes these if that is wanted; true when it is there.
    pub fn merge_turn(
        &mut self,
        task: &FrameTask,
        prepared: Result<&Ready, RenderError>,
        preparation: Preparation,
        remove: bool,
    ) -> bool {
        let mut record = self.record(task, preparation);
        let picture = record.output.clone();
        let wanted = prepared.as_ref().map(|ready| self.wanted(task, ready)).ok();
        let outcome = prepared.and_then(|ready| self.put_together(task, ready, &mut record));
        let is_done = self.settle(task, record, Status::Complete, outcome).is_some();
        if let Some(wanted) = wanted.filter(|_| is_done && remove) {
            remove_partials(&wanted, &picture);
        }
        is_done
    }

    fn put_together(
        &mut self,
        task: &FrameTask,
        ready: &Ready,
        record: &mut FrameRecord,
    ) -> Result<FrameImage, RenderError> {
        let wanted = self.wanted(task, ready);
        let Merged { sums, beams, took } = merged(&wanted, &record.output)?;
        let draw = |_: &Self| {
            let (image, counters) = sums.finish();
            Ok(Drawn { image, counters, beams, stopped_by: StoppedBy::Samples, dropped: 0 })
        };
        let image = self.trace(task, &ready.assembled, true, record, draw)?;
        record.render_seconds = took.seconds;
        record.cpu_seconds = Some(took.cpu_seconds);
        record.threads = took.threads();
        self.publish(task, ready, &image, record)?;
        Ok(image)
    }

    fn wanted(&self, task: &FrameTask, ready: &Ready) -> Wanted {
        Wanted {
            number: task.number,
            resolution: ready.assembled.frame.views.opening.resolution(),
            samples: self.settings.samples,
            fingerprint: ready.identity.fingerprint,
        }
    }
}
