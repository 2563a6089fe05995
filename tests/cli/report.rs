//! `floe report`: what ledgers tell.

use serde_json::Value;

use super::{boxes, floe, frame};

#[test]
fn two_shards_are_one_report() {
    let folder = boxes(5, "");
    folder.write(&frame(5), "ply\n");
    let shard = ["render", "boxes", "--keep-going", "--shard"];
    let objects = floe(&folder, &[&shard[..], &["1/2", "--progress", "json"]].concat()).ended(65).stderr;
    assert!(objects.lines().all(|line| line.contains("\"shard\":1")), "{objects}");
    floe(&folder, &[&shard[..], &["2/2", "--frames", "1-3"]].concat()).ended(0);
    let files = ["--csv", "frames.csv", "--svg", "error.svg"];
    let text = floe(&folder, &[&["report", "boxes"], &files[..]].concat()).ended(0).stdout;
    for words in [
        "complete    3 of 5 (1-3)\n",
        "failed      1 of 5 (5)\n",
        "missing     1 of 5 (4)\n",
        "frame 5: ",
        " core hours of CPU, ",
        "\nerror       ",
        "  as it is\n",
        "\nslowest frames\n",
        "\nimbalance ",
    ] {
        assert!(text.contains(words), "no \"{words}\" in\n{text}");
    }
    let csv = String::from_utf8(folder.read("frames.csv")).unwrap();
    assert_eq!(csv.lines().count(), 6, "{csv}");
    assert!(csv.contains("\n4,missing,,0,0,"), "{csv}");
    assert!(String::from_utf8(folder.read("error.svg")).unwrap().starts_with("<svg "));
    let json = floe(&folder, &["report", "boxes", "--json"]).ended(0).stdout;
    let json: Value = serde_json::from_str(&json).unwrap();
    let own: Vec<(&Value, f64)> = json["shards"]["shards"]
        .as_array()
        .unwrap()
        .iter()
        .map(|shard| (&shard["pictures"], shard["effort"]["cpu_seconds"].as_f64().unwrap()))
        .collect();
    assert!(own[0].0 == 2 && own[1].0 == 1, "{json:#}");
    // The sum of the lines is what the processes took for these frames, and the clock goes on.
    assert!(own.iter().all(|(_, cpu)| *cpu > 0.0 && *cpu < 600.0), "{json:#}");
    assert!(json["shards"]["elapsed_seconds"].as_f64().unwrap() > 0.0, "{json:#}");
    assert_eq!(json["frames"][0]["effort"]["samples"], 16 * 9 * 4);
    // Of some frames, and of the folder of the pictures alone.
    let some = floe(&folder, &["report", "boxes", "--frames", "2-3"]).ended(0).stdout;
    assert!(some.starts_with("complete    2 of 2 (2,3)\n"), "{some}");
    let alone = floe(&folder, &["report", "out/boxes"]).ended(0).stdout;
    assert!(alone.starts_with("complete    3 of 4 (1-3)\nfailed      1 of 4 (5)\n"), "{alone}");
}

#[test]
fn what_is_not_of_these_pictures_is_told() {
    let folder = boxes(1, "");
    floe(&folder, &["render", "boxes", "-o", "a.exr"]).ended(0);
    floe(&folder, &["render", "boxes", "-o", "b.exr"]).ended(0);
    let mut ledger = folder.read("ledger.jsonl");
    ledger.extend(b"{\"frame\":\"1\",\"stat");
    folder.write("ledger.jsonl", ledger);
    let text = floe(&folder, &["report", "boxes", "-o", "b.exr"]).ended(0).stdout;
    assert!(text.starts_with("complete    1 of 1 (1)\n"), "{text}");
    assert!(text.contains("\nlines that are torn, left out: 1 (first ./ledger.jsonl, line 3)\n"), "{text}");
    let other = "\nlines that are of pictures of other names, left out: 1 (first ./ledger.jsonl, line 1)\n";
    assert!(text.contains(other), "{text}");
}

#[test]
fn where_there_is_no_ledger_it_is_said_what_to_do() {
    let folder = boxes(1, "");
    let words = ["there is no ledger.jsonl in out/boxes", "render first"];
    floe(&folder, &["report", "boxes"]).ended(66).says(&words);
    floe(&folder, &["report", "nowhere"]).ended(66).says(&["nowhere"]);
    floe(&folder, &["report", "boxes", "-o", "a.png"]).ended(2).says(&["exr"]);
}
