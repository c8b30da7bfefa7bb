// What the command line says of itself: its help in lines that fit, and what was meant by a word that it does not know.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

namespace merlin::cli {

// CLI11's own, with descriptions wrapped to the terminal, or to 80 columns where there is none.
std::shared_ptr<CLI::FormatterBase> HelpFormatter();

// The error in one sentence; an unknown option or subcommand with the nearest that there is.
std::string Explain(const CLI::App& app, const CLI::ParseError& error);

}  // namespace merlin::cli
