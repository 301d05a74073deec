//! `lacuna report`: the page of a diagnosis, drawn again from what was stored beside it.

use super::{run, scratch};

#[test]
fn a_lost_page_is_drawn_again_and_a_damaged_store_is_refused() {
    let folder = scratch("report");
    run(&folder, "demo").exits(0);
    let page = folder.join("lacuna-out/report.html");
    let first = std::fs::read_to_string(&page).unwrap();
    std::fs::remove_file(&page).unwrap();
    run(&folder, "report").exits(0);
    let again = std::fs::read_to_string(&page).unwrap();
    for what in ["<figure ", "<h2 ", "<td ", "<svg ", "Dry friction"] {
        assert_eq!(first.matches(what).count(), again.matches(what).count(), "{what}");
    }
    // any file of the folder names it, and drawing once more changes nothing
    run(&folder, "report lacuna-out/diagnosis.json --out other.html").exits(0);
    assert_eq!(again, std::fs::read_to_string(folder.join("other.html")).unwrap());
    std::fs::write(folder.join("lacuna-out/report-data.json"), "{\"schema\":1}").unwrap();
    let ran = run(&folder, "report").exits(1);
    assert!(ran.err.contains("not the stored form of a report"), "{}", ran.err);
    let ran = run(&folder, "report nowhere").exits(2);
    assert!(ran.err.contains("report-data.json: cannot be read"), "{}", ran.err);
}
