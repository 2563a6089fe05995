use super::*;
use crate::study::convergence::{Bias, CrossCheck, ReferenceFacts};

fn point(samples: u32) -> BudgetPoint {
    let seconds = 0.01 * f64::from(samples);
    let known = |value: f64| Estimate { value, half_width: 0.05 * value };
    BudgetPoint {
        samples,
        repeats: 8,
        cpu_seconds: known(seconds),
        seconds,
        rays: 1e6,
        rmse: known(0.1 / seconds.sqrt()),
        relative_mse: known(0.02 / seconds),
        trimmed: 0.01 / seconds,
        median: 0.005 / seconds,
        flip: 0.1,
        variance: 0.01 / seconds,
        efficiency: 100.0,
        cost: [0.02, 0.01, 0.005],
        estimated_error: 0.11,
        true_error: 0.125,
        bias: Bias { relative: -0.001, t: -0.5, p: 0.62 },
    }
}

fn results() -> ConvergenceResults {
    let series = |name: &str, left_out| Series {
        name: name.into(),
        left_out,
        points: [4, 8, 16].map(point).to_vec(),
        slope_by_time: Some(Estimate { value: -0.5, half_width: 0.012 }),
        slope_by_samples: None,
        seconds_to_error: Some([1.0, 1.5, 2.0]),
    };
    let bias = Bias { relative: 0.0001, t: 0.4, p: 1.0 };
    ConvergenceResults {
        scene: "pool & sun".into(),
        frame: "6".into(),
        resolution: [16, 9],
        reference_file: "out/study/pool/reference.exr".into(),
        reference: ReferenceFacts {
            integrator: "path".into(),
            samples: 4096,
            correlation: 1.0,
            check: Some(CrossCheck { integrator: "photon".into(), samples: 512, bias }),
        },
        reference_noise: 1e-3,
        error: Some(0.05),
        series: vec![series("path, kind = \"x\"", vec![]), series("photon", vec!["the sun"])],
        end: End::Time,
    }
}

#[test]
fn columns_line_up_under_their_heads() {
    let text = text(&results());
    let blocks: Vec<Vec<&str>> = text.split("\n\n").map(|block| block.lines().collect()).collect();
    assert_eq!(blocks[0].len(), 3, "{text}");
    let columns = &blocks[1][1..5];
    assert!(columns.iter().all(|line| line.len() == columns[0].len()), "{text}");
    for words in [
        "photon (512 samples) differs from it by 0.010 % (t 0.40, p 1.00)",
        "photon (leaves out the sun)",
        "rmse falls with CPU time to the power -0.500 +- 0.012",
        "a relative error of 0.05 takes 1.500e0 s of CPU (1.000e0 to 2.000e0)",
        "time was up",
    ] {
        assert!(text.contains(words), "{words}\n{text}");
    }
}

/// Programs read these: a name that changes is a change for all of them.
#[test]
fn values_have_their_names_and_all_their_digits() {
    let csv = csv(&results());
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(
        lines[0],
        "series,samples,repeats,cpu_seconds,cpu_seconds_half_width,seconds,rays,rmse,rmse_half_width,relmse,\
         relmse_half_width,relmse_trimmed,relmse_median,flip,variance,efficiency,cost,cost_trimmed,cost_median,\
         estimated_error,true_error,bias,bias_t,bias_p"
    );
    assert_eq!(lines.len(), 7);
    assert!(
        lines[1].starts_with("\"path, kind = \"\"x\"\"\",4,8,0.04,0.002,0.04,1000000,0.5,0.025,"),
        "{csv}"
    );
    let value: serde_json::Value = serde_json::from_str(&json(&results())).unwrap();
    let keys = |value: &serde_json::Value| -> Vec<String> {
        let mut keys: Vec<String> = value.as_object().unwrap().keys().cloned().collect();
        keys.sort();
        keys
    };
    let top = "end error frame reference reference_file reference_noise resolution scene series";
    assert_eq!(keys(&value).join(" "), top);
    let series = "left_out name points seconds_to_error slope_by_samples slope_by_time";
    assert_eq!(keys(&value["series"][0]).join(" "), series);
    let points = "bias cost cpu_seconds efficiency estimated_error flip median rays relative_mse repeats rmse samples \
                  seconds trimmed true_error variance";
    assert_eq!(keys(&value["series"][1]["points"][2]).join(" "), points);
    assert_eq!(value["end"], "time");
    assert_eq!(value["series"][0]["points"][0]["rmse"]["value"], 0.5);
}

/// The line of the slope is under all data, and the page holds diagram and columns.
#[test]
fn the_diagram_shows_what_was_measured() {
    let plot = plot(&results());
    assert_eq!(plot.series[0].name, "path, kind = \"x\": \u{2212}0.500 \u{b1} 0.012");
    assert_eq!(plot.series[0].points[1].y_range.map(|r| r[0] < r[1]), Some(true));
    let Some(Guide::Slope { slope, through: [x, y], .. }) = plot.guides.last() else { panic!("{plot:?}") };
    for point in plot.series.iter().flat_map(|series| &series.points) {
        assert!(y * (point.x / x).powf(*slope) < point.y, "{point:?}");
    }
    let html = html(&results());
    assert!(html.contains("<svg") && html.contains("pool &amp; sun") && html.contains("true"), "{html}");
    assert!(!html.contains("<script"), "{html}");
}
