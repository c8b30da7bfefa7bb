// The text of the command line's help and of its errors. Help is wrapped to the terminal; an error about an unknown word
// names the most similar known one.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

namespace merlin::cli {

// CLI11's formatter, with descriptions wrapped to the width of the terminal; 80 columns if there is no terminal.
std::shared_ptr<CLI::FormatterBase> HelpFormatter();

// The error as one sentence. For an unknown option or subcommand it names the most similar one.
std::string Explain(const CLI::App& app, const CLI::ParseError& error);

}  // namespace merlin::cli
