//! `plugin!(A, B)`: one line that makes a crate's stages a plugin, and registers them where it is
//! linked in.

use proc_macro2::TokenStream;
use quote::quote;
use syn::parse::{Parse, ParseStream};
use syn::{LitInt, Path, Token};

/// What stands in the brackets: stages, then perhaps `; minor = 0`.
struct Stages {
    stages: Vec<Path>,
    minor: Option<LitInt>,
}

impl Parse for Stages {
    fn parse(input: ParseStream<'_>) -> syn::Result<Self> {
        let mut stages: Vec<Path> = vec![input.parse()?];
        while input.peek(Token![,]) {
            input.parse::<Token![,]>()?;
            if input.is_empty() || input.peek(Token![;]) {
                break;
            }
            stages.push(input.parse()?);
        }
        let mut minor = None;
        if input.peek(Token![;]) {
            input.parse::<Token![;]>()?;
            let word: syn::Ident = input.parse()?;
            if word != "minor" {
                return Err(syn::Error::new_spanned(word, "expected `minor = 0`"));
            }
            input.parse::<Token![=]>()?;
            minor = Some(input.parse()?);
        }
        Ok(Stages { stages, minor })
    }
}

pub(crate) fn expand(input: TokenStream) -> syn::Result<TokenStream> {
    let Stages { stages, minor } = syn::parse2(input)?;
    // Several plugins may be linked into one program: each exports a name of its own.
    let name = std::env::var("CARGO_CRATE_NAME").unwrap_or_else(|_| "unnamed".into());
    let symbol = format!("toile_plugin_{name}");
    let minor = minor.map_or(quote!(::toile_core::plugin::abi::MINOR), |m| quote!(#m));
    Ok(quote! {
        /// Adds every stage of this crate, where it is linked in and not loaded.
        pub fn register(registry: &mut ::toile_core::Registry) {
            #(registry.add::<#stages>();)*
        }

        const _: () = {
            use ::toile_core::plugin::{abi, sdk};

            const MINOR: u32 = #minor;

            fn make() -> ::std::vec::Vec<abi::StageTable> {
                ::std::vec![#(sdk::table::<#stages>()),*]
            }

            extern "C" fn stages(count: *mut usize) -> *const ::std::ffi::c_void {
                static TABLES: sdk::Tables = sdk::Tables::new();
                TABLES.give(MINOR, make, count)
            }

            #[allow(unsafe_code)]
            #[unsafe(export_name = #symbol)]
            static DECLARATION: abi::Declaration =
                sdk::declaration(env!("CARGO_PKG_NAME"), env!("CARGO_PKG_VERSION"), MINOR, stages);
        };
    })
}
