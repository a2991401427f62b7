use super::*;

#[test]
fn look() {
    let effort = if std::env::var("FULL").is_ok() { Effort::Full } else { Effort::Quick };
    let start = Instant::now();
    let all =
        readings(effort, 0, &|what, part| eprintln!("{:.2} {what} {part:.2}", start.elapsed().as_secs_f64())).unwrap();
    eprintln!("{}", all.wall_seconds);
    for row in &all.rows {
        let shares: Vec<String> = row
            .shares
            .iter()
            .map(|s| format!("{} {:.1} ±{:.1}", &s.factor[..2], s.share, s.interval.map_or(0.0, |i| (i.1 - i.0) / 2.0)))
            .collect();
        eprintln!("{:14} {:45} {:6.2} {}", row.group, row.id, row.distance, shares.join(" "));
    }
    std::fs::write("/tmp/rd/readings.csv", readings_csv(&all)).unwrap();
    std::fs::write("/tmp/rd/small.csv", small_samples_csv(&all)).unwrap();
}

#[test]
fn look_charts() {
    let effort = if std::env::var("FULL").is_ok() { Effort::Full } else { Effort::Quick };
    let all = readings(effort, 0, &|_, _| ()).unwrap();
    for line in summary(&all) {
        eprintln!("{line}");
    }
    for (name, chart) in [("distance", distance_chart(&all)), ("small", small_sample_chart(&all))] {
        let svg = chart.svg().unwrap();
        std::fs::write(format!("/tmp/rd/{name}.png"), crate::report::chart::png(&svg).unwrap().bytes).unwrap();
    }
    std::fs::write("/tmp/rd/r.json", readings_json(&all)).unwrap();
    std::fs::write("/tmp/rd/readings.csv", readings_csv(&all)).unwrap();
    std::fs::write("/tmp/rd/small.csv", small_samples_csv(&all)).unwrap();
}
