//! A setting as the command line and qualities write it: a path and a value.

/// One `--set PATH=VALUE`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Override {
    /// Names with dots between them: `stages.GridMesher.edge`.
    pub path: String,
    /// A RON value: `"6 mm"`.
    pub value: String,
}

impl std::str::FromStr for Override {
    type Err = String;

    /// Splits `PATH=VALUE` at its first `=`.
    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            Some((path, value)) if !path.trim().is_empty() && !value.trim().is_empty() => {
                Ok(Override { path: path.trim().to_owned(), value: value.trim().to_owned() })
            }
            _ => Err(format!("`{text}` is not PATH=VALUE, like `body.height=\"1.8 m\"`")),
        }
    }
}
