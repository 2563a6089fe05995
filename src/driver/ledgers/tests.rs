use super::*;
use crate::driver::ledger::{Ledger, RelativeError, Status};

fn written(folder: &Path, name: &str, text: &str) {
    std::fs::write(folder.join(name), text).unwrap();
}

fn line(frame: &str, ended: f64) -> String {
    format!(r#"{{"frame":"{frame}","status":"complete","output":"out/frame_{frame}.exr","ended":{ended}}}"#)
}

#[test]
fn ledgers_have_the_names_that_they_have() {
    for (name, shard) in [
        ("ledger.jsonl", Some(None)),
        ("ledger.1.jsonl", Some(Some(1))),
        ("ledger.12.jsonl", Some(Some(12))),
        ("ledger.+1.jsonl", None),
        ("ledger..jsonl", None),
        ("ledger.1.2.jsonl", None),
        ("ledger.1.jsonl~", None),
        ("my_ledger.1.jsonl", None),
    ] {
        assert_eq!(shard_of(OsStr::new(name)), shard, "{name}");
    }
}

#[test]
fn shards_are_put_together_in_the_order_of_time() {
    let folder = tempfile::tempdir().unwrap();
    written(folder.path(), "ledger.10.jsonl", &format!("{}\n", line("7", 30.0)));
    written(folder.path(), "ledger.2.jsonl", &format!("{}\n{}\n", line("7", 40.0), line("-1", 10.0)));
    let old = r#"{"frame":"7","status":"interrupted","output":"a.exr","an older or a newer key":[1]}"#;
    written(folder.path(), "ledger.jsonl", old);
    let ledgers = Ledgers::in_folder(folder.path()).unwrap();
    let names: Vec<_> =
        ledgers.files.iter().map(|file| file.file_name().unwrap().to_str().unwrap()).collect();
    assert_eq!(names, ["ledger.jsonl", "ledger.2.jsonl", "ledger.10.jsonl"]);
    let lines: Vec<_> = ledgers.lines.iter().map(|l| (l.record.frame.as_str(), l.shard, l.place)).collect();
    let expected =
        [("-1", Some(2), (1, 2)), ("7", None, (0, 1)), ("7", Some(10), (2, 1)), ("7", Some(2), (1, 1))];
    assert_eq!(lines, expected);
    assert_eq!(ledgers.unusable, []);
}

#[test]
fn a_ledger_that_cannot_be_read_is_named() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("ledger.5.jsonl")).unwrap();
    let error = Ledgers::in_folder(folder.path()).unwrap_err().to_string();
    assert!(error.contains("ledger.5.jsonl: "), "{error}");
}

#[test]
fn what_is_no_line_is_told_and_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let whole = line("3", 1.0);
    let half = &line("2", 1.0)[..40];
    let foreign = r#"{"frame":"../3","status":"complete"}"#;
    let unknown = r#"{"frame":"3","status":"dancing"}"#;
    let text = format!("{half}{whole}\n\n[1]\n{foreign}\n{unknown}\n\0\0\n{half}");
    written(folder.path(), "ledger.jsonl", &text);
    let ledgers = Ledgers::in_folder(folder.path()).unwrap();
    assert_eq!(ledgers.lines.iter().map(|line| line.record.frame.as_str()).collect::<Vec<_>>(), ["3"]);
    let told: Vec<_> = ledgers.unusable.iter().map(|problem| (problem.line, problem.reason)).collect();
    let [torn, foreign] = [Reason::Torn, Reason::Foreign];
    assert_eq!(told, [(1, torn), (3, foreign), (4, foreign), (5, foreign), (6, torn), (7, torn)]);
}

#[test]
fn pictures_of_another_name_are_not_ours() {
    let folder = tempfile::tempdir().unwrap();
    written(folder.path(), "ledger.jsonl", &format!("{}\n{}\n", line("3", 1.0), line("4", 1.0)));
    let mut ledgers = Ledgers::in_folder(folder.path()).unwrap();
    ledgers.keep_pictures(|_| "elsewhere/frame_4.exr".into());
    assert_eq!(ledgers.lines.iter().map(|line| line.record.frame.as_str()).collect::<Vec<_>>(), ["4"]);
    let file = folder.path().join("ledger.jsonl");
    assert_eq!(ledgers.unusable, [Unusable { file, line: 1, reason: Reason::Other }]);
}

#[test]
fn a_line_is_read_as_it_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("frame_12.5.exr");
    let estimate = RelativeError { estimate: 0.1, low: 0.05, high: f64::INFINITY, confidence: 0.95 };
    let mut record = FrameRecord::failed("12.5".into(), None, picture.clone());
    record.status = Status::Preview;
    record.relative_error = Some(estimate);
    record.counters.rays = u64::MAX;
    record.end();
    assert!(record.ended > Some(1.7e9) && record.cpu_seconds >= Some(0.0), "{record:?}");
    // JSON is read to the last digit but one: what is compared has few of them.
    record.cpu_seconds = Some(0.25);
    record.ended = Some(1_700_000_000.5);
    Ledger::beside(&picture, None, None).unwrap().append(&record).unwrap();
    let ledgers = Ledgers::in_folder(folder.path()).unwrap();
    assert_eq!(format!("{:?}", ledgers.lines[0].record), format!("{record:?}"));
}

#[test]
fn no_folder_has_no_ledgers() {
    assert!(Ledgers::in_folder(Path::new("/nowhere/at/all")).unwrap().files.is_empty());
}
