//! `#[choice]`: an enum, or a small struct, as a parameter.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{Fields, Item};

pub(crate) fn expand(item: Item) -> syn::Result<TokenStream> {
    match item {
        Item::Enum(item) => {
            let words: Vec<String> = item.variants.iter().map(variant_words).collect();
            let arms = item.variants.iter().map(number_arm);
            let name = &item.ident;
            let imp = param_type(name, &words.join(" | "), quote!(match self { #(#arms)* }));
            Ok(quote! {
                #[derive(Debug, Clone, PartialEq, ::toile_core::serde::Serialize, ::toile_core::serde::Deserialize)]
                #[serde(crate = "::toile_core::serde", deny_unknown_fields)]
                #item
                #imp
            })
        }
        Item::Struct(item) => {
            let fields: Vec<_> = item.fields.iter().filter_map(|f| f.ident.as_ref()).collect();
            let words: Vec<String> = fields.iter().map(|f| format!("{f}: ...")).collect();
            let name = &item.ident;
            let body = quote! {
                [#(::toile_core::ParamType::numbers(&self.#fields)),*].concat()
            };
            let imp = param_type(name, &format!("({})", words.join(", ")), body);
            Ok(quote! {
                #[derive(Debug, Clone, PartialEq, ::toile_core::serde::Serialize, ::toile_core::serde::Deserialize)]
                #[serde(crate = "::toile_core::serde", deny_unknown_fields)]
                #item
                #imp
            })
        }
        other => Err(syn::Error::new_spanned(other, "`#[choice]` stands on an enum or a struct")),
    }
}

fn param_type(name: &syn::Ident, words: &str, numbers: TokenStream) -> TokenStream {
    quote! {
        impl ::toile_core::ParamType for #name {
            fn describe() -> ::std::string::String { #words.into() }
            fn numbers(&self) -> ::std::vec::Vec<f64> { #numbers }
        }
    }
}

/// A variant as it is written: `KDop(whole number)`.
fn variant_words(v: &syn::Variant) -> String {
    match &v.fields {
        Fields::Unit => v.ident.to_string(),
        Fields::Unnamed(_) => format!("{}(...)", v.ident),
        Fields::Named(named) => {
            let names: Vec<String> =
                named.named.iter().filter_map(|f| f.ident.as_ref()).map(|i| format!("{i}: ...")).collect();
            format!("{}({})", v.ident, names.join(", "))
        }
    }
}

/// The match arm that collects a variant's numbers.
fn number_arm(v: &syn::Variant) -> TokenStream {
    let name = &v.ident;
    match &v.fields {
        Fields::Unit => quote!(Self::#name => ::std::vec::Vec::new(),),
        Fields::Unnamed(fields) => {
            let vars: Vec<_> = (0..fields.unnamed.len()).map(|i| quote::format_ident!("x{i}")).collect();
            quote!(Self::#name(#(#vars),*) => [#(::toile_core::ParamType::numbers(#vars)),*].concat(),)
        }
        Fields::Named(fields) => {
            let vars: Vec<_> = fields.named.iter().filter_map(|f| f.ident.as_ref()).collect();
            quote!(Self::#name { #(#vars),* } => [#(::toile_core::ParamType::numbers(#vars)),*].concat(),)
        }
    }
}
