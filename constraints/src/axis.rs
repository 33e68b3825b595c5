//! Joints whose one axis the scene gives.

/// The spec of a joint whose axis the scene gives: `"name" => Spec, joint; what the axis is`.
macro_rules! along_an_axis {
    ($($(#[$what:meta])+ $name:literal => $spec:ident, $joint:ident; $axis:literal)+) => {$(
        $(#[$what])+
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
        #[serde(deny_unknown_fields)]
        pub struct $spec {
            /// Name; records of the reaction refer to it.
            pub name: String,
            /// The marker that is held.
            pub marker: ropewalk_scene::MarkerRef,
            /// The other marker, or a point in space. Default: the point where `marker` starts.
            #[serde(default)]
            pub to: Option<ropewalk_scene::MarkerRef>,
            #[doc = $axis]
            pub axis: ropewalk_core::V3<f64>,
        }
        ropewalk_scene::register_spec!(Constraint, $name, $spec);

        #[typetag::serde(name = $name)]
        impl ropewalk_scene::ConstraintSpec for $spec {
            fn name(&self) -> &str {
                &self.name
            }
            fn markers(&self) -> Vec<&ropewalk_scene::MarkerRef> {
                std::iter::once(&self.marker).chain(&self.to).collect()
            }
            fn build(&self, b: &mut ropewalk_scene::Builder) -> Result<(), ropewalk_core::BuildError> {
                let markers = crate::pair::pair(b, &self.marker, self.to.as_ref())?;
                let markers = crate::pair::aligned(b, markers, crate::pair::along("axis", self.axis)?);
                b.constraint($joint(&self.name, b.nodes(), markers)?)
            }
        }
    )+};
}

pub(crate) use along_an_axis;
