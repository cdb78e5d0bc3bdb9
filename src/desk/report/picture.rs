//! Pictures in a page.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::html::{Html, missing};
use plot::{Canvas, Chart};

/// Width of charts (pixels).
pub const WIDTH: u32 = 1000;

/// A chart with an alternative text, or why there is none.
pub fn chart(chart: Result<Chart, String>, alt: &str) -> Html {
    let draw = |chart: Chart| chart.draw(Some(WIDTH)).map_err(|error| error.to_string());
    image(chart.and_then(draw), alt)
}

/// A picture with an alternative text, or why there is none. As an image of its own it is drawn
/// without the page's styles.
pub fn image(canvas: Result<Canvas, String>, alt: &str) -> Html {
    match canvas {
        Ok(canvas) => {
            let source = format!(
                "data:image/svg+xml;base64,{}",
                STANDARD.encode(canvas.svg())
            );
            let attributes = [("src", source.as_str()), ("alt", alt)];
            Html::element(
                "figure",
                &[],
                Html::element("img", &attributes, Html::default()),
            )
        }
        Err(error) => missing(&error),
    }
}
