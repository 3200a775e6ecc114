use super::*;

#[test]
fn a_prompt_is_a_click_or_a_box() {
    let click = prompt_of(&[3.0, 4.0]).ok();
    assert_eq!(click, Some(Prompt::Click(Point::new(3.0, 4.0))));
    let boxed = prompt_of(&[1.0, 2.0, 3.0, 4.0]).ok();
    let wanted = Prompt::Box(Point::new(1.0, 2.0), Point::new(3.0, 4.0));
    assert_eq!(boxed, Some(wanted));
}

/// Knees are filmed from farther away than its library serves; where a file tells the distance they are where it says.
#[test]
fn a_click_looks_farther_where_nobody_told_the_distance() {
    let film = FrameImage::from_eight_bit(vec![0; 64 * 64], 64, 64).unwrap();
    let untold = |calibration: &str| {
        let click = OneClick::new(&film, calibration, &[31.0, 31.0], Some(false));
        click.unwrap().untold
    };
    let matrix = "image size\n64,64\n\ncamera matrix\n3000,0,31.5\n0,3000,31.5\n0,0,1\n\n\
        rotation\n1,0,0\n0,1,0\n0,0,1\n\ntranslation\n0\n0\n0\n";
    assert_eq!(untold(matrix), Some(1000.0));
    assert_eq!(untold("JT_INTCALIB\n1200\n0\n0\n0.4\n"), None);
}
