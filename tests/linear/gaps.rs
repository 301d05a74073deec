//! Several records, missing values, slow and integrating machines.

use super::*;

const NOISE: Noise = Noise { share: 0.05, pole: 0.0 };

#[test]
fn several_records_count_together() {
    let mut random = Random::new(21);
    let truth = Truth::random(&mut random, 4, 1, 1);
    let records: Vec<Record> = (0..4).map(|_| truth.record(&mut random, 400, 0.0, NOISE)).collect();
    let one = linear(&records[..1], Some(4)).unwrap();
    let all = linear(&records, Some(4)).unwrap();
    assert!(truth.off(&all) < 0.02, "{}", truth.off(&all));
    assert!(truth.off(&all) < truth.off(&one));
}

#[test]
fn missing_values_cost_little() {
    let mut random = Random::new(22);
    let truth = Truth::random(&mut random, 3, 1, 2);
    let mut record = truth.record(&mut random, 3000, 0.0, NOISE);
    // every tenth output is missing, so that hardly any stretch is whole
    for k in 0..3000 {
        if random.uniform() < 0.1 {
            record.outputs[k % 2].values[k] = f64::NAN;
        }
    }
    let mut inputs = record.inputs[0].values.clone();
    for k in [700, 701, 1900] {
        inputs[k] = f64::NAN;
    }
    let mut cut = Record::new(0.1).input("u1", inputs).unwrap();
    for y in &record.outputs {
        cut = cut.output(&y.name, y.values.clone()).unwrap();
    }
    assert_eq!(cut.segments.len(), 3);
    let found = linear(&[cut], Some(3)).unwrap();
    assert!(truth.off(&found) < 0.02, "{}", truth.off(&found));
}

#[test]
fn slow_and_integrating_machines() {
    // two real poles near 1 that are nearly equal, and an integrator behind a lag
    for (what, p, q) in [("slow", 0.985, 0.98), ("integrating", 1.0, 0.8)] {
        let mut random = Random::new(23);
        let truth = Truth {
            a: DMatrix::from_row_slice(2, 2, &[p, 0.1, 0.0, q]),
            b: DMatrix::from_row_slice(2, 1, &[0.0, 0.2]),
            c: DMatrix::from_row_slice(1, 2, &[1.0, 0.0]),
            d: DMatrix::zeros(1, 1),
        };
        let record = truth.record(&mut random, 2000, 0.0, Noise { share: 0.02, pole: 0.0 });
        let found = linear(std::slice::from_ref(&record), Some(2)).unwrap();
        let size = record.outputs[0].std();
        let off = rmse(&found, &record, 50)[0];
        println!("{what}: RMSE {:.2} % of the output", 100.0 * off / size);
        assert!(off < 0.03 * size, "{what}: {off} of {size}");
        assert!(found.modes.iter().all(|m| m.pole[0].hypot(m.pole[1]) < 1.0), "{:?}", found.modes);
    }
}

#[test]
fn a_step_response_is_enough() {
    let mut random = Random::new(24);
    let y = (0..400).map(|k| 3.0 + 2.0 * (1.0 - 0.95_f64.powi((k - 50).max(0))));
    let record = Record::new(0.5)
        .input("valve", (0..400).map(|k| if k < 50 { 0.0 } else { 1.0 }).collect::<Vec<_>>())
        .unwrap()
        .output("level", y.map(|y| y + 0.01 * random.normal()).collect::<Vec<_>>())
        .unwrap();
    let found = linear(&[record], Some(1)).unwrap();
    assert!((found.modes[0].pole[0] - 0.95).abs() < 0.003, "{:?}", found.modes);
    let time = found.modes[0].time_constant.unwrap();
    assert!((time - -0.5 / 0.95_f64.ln()).abs() < 0.5, "{time}");
}
