//! PNG and PDF of a picture that was drawn as SVG, in programs built with the feature `raster`.

#[cfg(feature = "raster")]
use std::sync::Arc;
#[cfg(feature = "raster")]
use svg2pdf::usvg::{Options, Tree};

/// A kind of picture besides SVG.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Raster {
    /// Pixels, three for each of the picture's units along a side: 288 to the inch.
    Png,
    /// A page of the picture's size, with its fonts.
    Pdf,
}

/// Pixels for each unit.
#[cfg(feature = "raster")]
const SCALE: f32 = 3.0;
/// What texts are set in where there is no Helvetica: the first that there is.
#[cfg(feature = "raster")]
const FAMILIES: [&str; 6] =
    ["Helvetica", "Arial", "Liberation Sans", "DejaVu Sans", "Noto Sans", "Nimbus Sans"];

impl Raster {
    /// Whether this program can make such pictures.
    pub const THERE: bool = cfg!(feature = "raster");

    /// The kind that a file of this ending holds.
    ///
    /// ```
    /// # use ropewalk_report::plot::Raster;
    /// assert_eq!(Raster::of("PNG"), Some(Raster::Png));
    /// assert_eq!(Raster::of("svg"), None);
    /// ```
    pub fn of(ending: &str) -> Option<Self> {
        match ending.to_ascii_lowercase().as_str() {
            "png" => Some(Raster::Png),
            "pdf" => Some(Raster::Pdf),
            _ => None,
        }
    }

    /// The picture as a file of this kind.
    ///
    /// # Errors
    /// In a sentence: the program was built without it, no font is installed, or the text is no SVG.
    #[cfg(not(feature = "raster"))]
    pub fn picture(self, _svg: &str) -> Result<Vec<u8>, String> {
        Err("this program was built without the feature `raster`".into())
    }

    /// The picture as a file of this kind.
    ///
    /// # Errors
    /// In a sentence: the program was built without it, no font is installed, or the text is no SVG.
    #[cfg(feature = "raster")]
    pub fn picture(self, svg: &str) -> Result<Vec<u8>, String> {
        let mut options = Options::default();
        let fonts = Arc::make_mut(&mut options.fontdb);
        fonts.load_system_fonts();
        // text without a font would be left away without a word
        let families = || fonts.faces().flat_map(|face| &face.families).map(|(name, _)| name.clone());
        let known: Vec<String> = families().collect();
        let first = FAMILIES.iter().find(|name| known.iter().any(|k| k == *name)).map(ToString::to_string);
        let Some(family) = first.or_else(|| known.first().cloned()) else {
            return Err("no font is installed on this machine: install one such as DejaVu Sans".into());
        };
        fonts.set_sans_serif_family(family);
        let tree = Tree::from_str(svg, &options).map_err(|e| e.to_string())?;
        match self {
            Raster::Pdf => {
                // a unit is a pixel of CSS
                let page = svg2pdf::PageOptions { dpi: 96.0 };
                svg2pdf::to_pdf(&tree, svg2pdf::ConversionOptions::default(), page).map_err(|e| e.to_string())
            }
            Raster::Png => {
                use resvg::tiny_skia::{Pixmap, Transform};
                let side = |x: f32| (SCALE * x).ceil() as u32;
                let size = (side(tree.size().width()), side(tree.size().height()));
                let mut pixels = Pixmap::new(size.0, size.1)
                    .ok_or_else(|| format!("a picture of {} by {} pixels is too large", size.0, size.1))?;
                resvg::render(&tree, Transform::from_scale(SCALE, SCALE), &mut pixels.as_mut());
                pixels.encode_png().map_err(|e| e.to_string())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SVG: &str = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100\" height=\"50\" \
                       font-family=\"Helvetica, Arial, DejaVu Sans, sans-serif\">\
                       <rect width=\"100\" height=\"50\" fill=\"#fff\"/><text x=\"10\" y=\"30\">z [m]</text></svg>";

    #[test]
    fn pictures_are_made_or_refused() {
        for kind in [Raster::Png, Raster::Pdf] {
            match kind.picture(SVG) {
                Ok(bytes) if kind == Raster::Png => {
                    assert!(bytes.starts_with(b"\x89PNG\r\n\x1a\n"));
                    let side = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
                    assert_eq!((side(16), side(20)), (300, 150));
                }
                Ok(bytes) => assert!(bytes.starts_with(b"%PDF-") && bytes.len() > 1000),
                Err(why) => assert!(!Raster::THERE || why.contains("font"), "{why}"),
            }
        }
        assert!(Raster::Png.picture("no picture").is_err());
    }
}
