//! The `stage` and `choice` macros: from one parameter struct and one typed function to the RON
//! form, the checks, the card and the [`Stage`] implementation.
//!
//! `#[stage(role = ..., source = "...", example = "...")]` stands on the parameter struct,
//! `#[stage]` on the `impl` with its `run` function, `#[choice]` on an enum used as a parameter,
//! `#[params]` on parameters that several stages share.

mod choice;
mod params;
mod plugin;
mod run;

use proc_macro::TokenStream;

/// See the crate's page.
#[proc_macro_attribute]
pub fn stage(attr: TokenStream, item: TokenStream) -> TokenStream {
    let expanded = match syn::parse::<syn::Item>(item) {
        Ok(syn::Item::Struct(item)) => params::expand(attr.into(), item),
        Ok(syn::Item::Impl(item)) => run::expand(item),
        Ok(other) => {
            Err(syn::Error::new_spanned(other, "`#[stage]` stands on a parameter struct or on its impl"))
        }
        Err(e) => Err(e),
    };
    expanded.unwrap_or_else(syn::Error::into_compile_error).into()
}

/// Makes a struct a group of parameters, which stages take by `#[param(flatten)]`.
#[proc_macro_attribute]
pub fn params(_attr: TokenStream, item: TokenStream) -> TokenStream {
    syn::parse::<syn::ItemStruct>(item)
        .and_then(params::expand_group)
        .unwrap_or_else(syn::Error::into_compile_error)
        .into()
}

/// Makes an enum usable as a parameter.
#[proc_macro_attribute]
pub fn choice(_attr: TokenStream, item: TokenStream) -> TokenStream {
    syn::parse::<syn::Item>(item)
        .and_then(choice::expand)
        .unwrap_or_else(syn::Error::into_compile_error)
        .into()
}

/// `plugin!(A, B);` at the end of a crate makes its stages a plugin: built as `cdylib` it can be
/// loaded by name, linked in it is added by one line, `my_crate::register(&mut registry)`.
#[proc_macro]
pub fn plugin(stages: TokenStream) -> TokenStream {
    plugin::expand(stages.into()).unwrap_or_else(syn::Error::into_compile_error).into()
}

/// The text of an item's doc comment.
fn doc_text(attrs: &[syn::Attribute]) -> String {
    let line = |a: &syn::Attribute| match &a.meta {
        syn::Meta::NameValue(syn::MetaNameValue {
            path,
            value: syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(s), .. }),
            ..
        }) if path.is_ident("doc") => Some(s.value()),
        _ => None,
    };
    let lines: Vec<String> =
        attrs.iter().filter_map(line).map(|l| l.strip_prefix(' ').unwrap_or(&l).to_owned()).collect();
    unwrapped(&lines).trim().to_owned()
}

/// Each paragraph and each entry of a list as one line; code and tables stay as they are.
fn unwrapped(lines: &[String]) -> String {
    let is_own = |line: &str| {
        let digits = line.trim_start_matches(|c: char| c.is_ascii_digit());
        ["- ", "* ", "|", "#", ">", "    ", "```"].iter().any(|start| line.starts_with(start))
            || digits.len() < line.len() && digits.starts_with(". ")
    };
    let (mut text, mut fenced, mut goes_on) = (String::new(), false, false);
    for line in lines {
        let was_fenced = fenced;
        fenced ^= line.starts_with("```");
        let is_prose = !was_fenced && !fenced && !line.trim().is_empty();
        if is_prose && goes_on && !is_own(line) {
            text.push(' ');
            text.push_str(line.trim());
        } else {
            text.push('\n');
            text.push_str(line);
        }
        goes_on = is_prose && !["|", "#", ">", "    "].iter().any(|start| line.starts_with(start));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::unwrapped;

    #[test]
    fn paragraphs_and_entries_of_lists_are_one_line_each() {
        let lines = [
            "One",
            "sentence.",
            "",
            "- an entry",
            "  of a list",
            "- another",
            "",
            "```",
            "let a",
            "= 1;",
            "```",
        ];
        let lines = lines.map(str::to_owned);
        let expected = "\nOne sentence.\n\n- an entry of a list\n- another\n\n```\nlet a\n= 1;\n```";
        assert_eq!(unwrapped(&lines), expected);
    }
}
