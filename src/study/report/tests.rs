use std::path::Path;

use super::*;

/// A line of 100 samples on two threads that took so many seconds, half a second of which is writing.
fn line(frame: u32, status: &str, seconds: f64, error: f64, ended: f64) -> String {
    let cpu = 1.5 * seconds;
    let render = seconds - 0.5;
    format!(
        r#"{{"frame":"{frame}","status":"{status}","output":"out/frame_{frame:04}.exr","render_seconds":{render},"write_seconds":0.5,"cpu_seconds":{cpu},"threads":2,"ended":{ended},"samples":100,"relative_error":{{"estimate":{error},"low":0.0,"high":null,"confidence":0.95}},"warnings":["frame {frame}: {frame} hits of 7.5"]}}"#
    ) + "\n"
}

/// The report of the ledgers of two shards.
fn report(first: &[String], second: &[String], expected: u32) -> SequenceReport {
    let folder = tempfile::tempdir().unwrap();
    let write =
        |name: &str, lines: &[String]| std::fs::write(folder.path().join(name), lines.concat()).unwrap();
    write("ledger.1.jsonl", first);
    write("ledger.2.jsonl", second);
    let expected: Vec<FrameNumber> = (1..=expected).map(FrameNumber::from).collect();
    SequenceReport::new(&Ledgers::in_folder(folder.path()).unwrap(), &expected, |_| true)
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9
}

#[test]
fn the_newest_line_counts_and_what_went_before_is_told() {
    let first = [
        line(1, "complete", 9.0, 0.5, 10.0),
        line(1, "failed", 2.0, 0.5, 20.0),
        line(1, "interrupted", 3.0, 0.5, 30.0),
        line(2, "failed", 1.0, 0.1, 12.0),
    ];
    // Shard 2 took over a frame of shard 1.
    let report = report(&first, &[line(1, "complete", 4.0, 0.1, 40.0)], 3);
    let states: Vec<_> = report.frames.iter().map(|frame| (frame.frame.as_str(), frame.state)).collect();
    assert_eq!(states, [("1", State::Complete), ("2", State::Failed), ("3", State::Missing)]);
    let one = &report.frames[0];
    assert_eq!((one.shard, one.restarts, one.failures, one.effort.lines), (Some(2), 1, 1, 3));
    assert!(close(one.effort.seconds, 9.0) && close(one.effort.cpu_seconds, 13.5), "{one:?}");
    assert!(close(one.effort.thread_seconds, 18.0) && one.effort.samples == 100, "{one:?}");
    assert!(close(report.total.seconds, 19.0) && close(report.superseded.seconds, 9.0), "{report:?}");
    assert_eq!(report.superseded.lines, 1);
    let text = text(&report);
    for words in [
        "complete    1 of 3 (1)\n",
        "failed      1 of 3 (2)\n",
        "missing     1 of 3 (3)\n",
        "broken off before: once (1)\n",
        "failed before: once (1)\n",
        "took        19.00 s, 0.0079 core hours of CPU, 0.0106 of threads; 5.000e2 samples\n",
        "within 39.00 s from the first frame to the last\n",
        "9.00 s and 0.0037 core hours of it for a line of pictures that were drawn again\n",
        "only bounded from below in 1\n",
        "warnings: 5\n       5 in 1,2: 1 hits of 7.5\n",
    ] {
        assert!(text.contains(words), "no \"{words}\" in\n{text}");
    }
}

#[test]
fn a_picture_that_was_cut_goes_on_and_one_that_was_whole_does_not() {
    let cut =
        line(1, "complete", 2.0, 0.5, 1.0).replace(r#""samples":"#, r#""stopped_by":"time","samples":"#);
    let whole = line(1, "complete", 3.0, 0.1, 2.0);
    let on = report(&[cut.clone(), whole.clone()], &[], 1);
    assert!(close(on.frames[0].effort.seconds, 5.0) && on.superseded.lines == 0, "{on:?}");
    let again = report(&[whole, cut.replace("\"ended\":1", "\"ended\":3")], &[], 1);
    assert_eq!((again.frames[0].state, again.superseded.lines), (State::Cut, 1));
}

/// Errors of 3 and 4 % are 3.54 % together. Of 10 CPU seconds each, 95 % are rendering: 5 % of error take
/// 1 + 19 (9 + 16) / 2 / 25 = 10.5 of them, and 1 % takes 1 + 9.5 (9 + 16).
#[test]
fn errors_and_what_others_would_take() {
    let seconds = 10.0 / 1.5;
    // Half a second of writing is 5 % of ten.
    let shorter = |text: String| {
        text.replace(
            &format!(r#""render_seconds":{}"#, seconds - 0.5),
            &format!(r#""render_seconds":{}"#, 0.95 * seconds),
        )
        .replace(r#""write_seconds":0.5"#, &format!(r#""write_seconds":{}"#, 0.05 * seconds))
    };
    let lines =
        [(1, 0.03), (2, 0.04)].map(|(frame, error)| shorter(line(frame, "complete", seconds, error, 9.0)));
    let errors = report(&lines, &[], 2).errors.unwrap();
    assert!(close(errors.root_mean_square, 12.5e-4_f64.sqrt()) && close(errors.median, 0.035), "{errors:?}");
    assert_eq!((errors.greatest, errors.greatest_frame.as_str()), (0.04, "2"));
    let costs: Vec<f64> = errors.costs.iter().map(|cost| cost.relative_error).collect();
    assert_eq!(costs, [0.05, 0.02, 0.01, 0.005]);
    assert!(close(errors.costs[0].cpu_seconds, 10.5), "{errors:?}");
    assert!(close(errors.costs[2].cpu_seconds, 1.0 + 9.5 * 25.0), "{errors:?}");
    assert_eq!(report(&[line(1, "failed", 1.0, 0.1, 1.0)], &[], 1).errors, None);
}

/// The median of 1, 2, 3, 4, 100 is 3 and that of the distances from it 1.
#[test]
fn few_slow_ones_do_not_move_the_threshold() {
    assert!(close(threshold(&[2.0, 1.0, 100.0, 3.0, 4.0]).unwrap(), 3.0 + 3.5 / 0.6745));
    assert_eq!(threshold(&[2.0; 9]), Some(3.0));
    assert_eq!(threshold(&[1.0, 1.0, 1.0, 100.0]), None);
}

#[test]
fn slow_frames_and_shards_are_told_with_their_reasons() {
    let seconds = [2.0, 2.1, 1.9, 2.0, 8.0, 2.0];
    let complete =
        |(i, seconds): (usize, &f64)| line(i as u32 + 1, "complete", *seconds, 0.1, 10.0 * (i + 1) as f64);
    let lines: Vec<String> = seconds.iter().enumerate().map(complete).collect();
    let report = report(&lines[..4], &lines[4..], 6);
    assert_eq!(report.slow.stragglers, ["5"]);
    let slowest = &report.slow.slowest[0];
    assert!(
        slowest.frame == "5" && slowest.most == "render" && close(slowest.times_median, 4.0),
        "{slowest:?}"
    );
    assert!(close(slowest.times_sample_seconds, 5.0) && close(slowest.times_samples, 1.0), "{slowest:?}");
    // 8 and 10 seconds.
    assert!(close(report.shards.imbalance.unwrap(), 10.0 / 9.0), "{report:?}");
    let shard = &report.shards.shards[1];
    assert!((shard.pictures, shard.shard) == (2, Some(2)), "{shard:?}");
    assert!(close(shard.begins.unwrap(), 34.0) && close(shard.ends.unwrap(), 52.0), "{shard:?}");
    let text = text(&report);
    assert!(text.contains("stragglers, above 3.00 s: 5\n") && text.contains("imbalance 1.11: "), "{text}");
    let csv = csv(&report);
    let heads = csv.lines().next().unwrap().split(',').count();
    assert!(csv.lines().count() == 7 && csv.lines().all(|line| line.split(',').count() == heads), "{csv}");
    assert!(
        csv.contains(
            "\n5,complete,2,8,12,16,0,0,7.5,0.5,100,,,0.1,0,,1,0,0,1,true,50,\"out/frame_0005.exr\"\n"
        ),
        "{csv}"
    );
    let svg = diagram(&report, "<all>").unwrap().svg();
    assert!(svg.contains("stragglers") && svg.contains("&lt;all&gt;"), "{svg}");
    crate::study::plot::parsed(&svg);
}

#[test]
fn nothing_is_no_reason_to_fail() {
    let folder = Path::new("/nowhere/at/all");
    let report = SequenceReport::new(&Ledgers::in_folder(folder).unwrap(), &[], |_| true);
    assert!(report.frames.is_empty() && diagram(&report, "").is_none());
    text(&report);
}
