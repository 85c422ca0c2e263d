#include "experiments/junit.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>

namespace framesim {
namespace {

std::string xml_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\n':
        out += "&#10;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
  }
  return out;
}

std::string lines(const std::vector<std::string>& texts) { return fmt::format("{}", fmt::join(texts, "\n")); }

std::size_t failed(const CheckedSuite& suite) {
  std::size_t count = 0;
  for (const CheckedCase& c : suite.cases) count += !c.failures.empty();
  return count;
}

std::string xml_case(const CheckedSuite& suite, const CheckedCase& c) {
  const std::string start =
      fmt::format("    <testcase classname=\"{}\" name=\"{}\"", xml_text(suite.name), xml_text(c.name));
  if (c.failures.empty()) return start + "/>\n";
  return fmt::format("{}>\n      <failure message=\"{}\">{}</failure>\n    </testcase>\n", start,
                     xml_text(c.failures.front()), xml_text(lines(c.failures)));
}

std::string markdown_cell(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '|' ? std::string("\\|") : c == '\n' ? std::string("<br>") : std::string(1, c);
  return out;
}

}  // namespace

std::string junit_xml(const std::vector<CheckedSuite>& suites) {
  std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  std::size_t cases = 0, failures = 0;
  for (const CheckedSuite& suite : suites) {
    cases += suite.cases.size();
    failures += failed(suite);
  }
  text += fmt::format("<testsuites name=\"framesim\" tests=\"{}\" failures=\"{}\">\n", cases, failures);
  for (const CheckedSuite& suite : suites) {
    text += fmt::format("  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"0\">\n",
                        xml_text(suite.name), suite.cases.size(), failed(suite));
    for (const CheckedCase& c : suite.cases) text += xml_case(suite, c);
    text += "  </testsuite>\n";
  }
  return text + "</testsuites>\n";
}

std::string markdown_summary(const std::string& heading, const std::vector<CheckedSuite>& suites) {
  std::string text = fmt::format("### {}\n\n", heading), rows;
  for (const CheckedSuite& suite : suites) {
    text += fmt::format("- {}: {} of {} rows as expected\n", markdown_cell(suite.name),
                        suite.cases.size() - failed(suite), suite.cases.size());
    for (const CheckedCase& c : suite.cases) {
      if (c.failures.empty()) continue;
      rows += fmt::format("| {} | {} | {} |\n", markdown_cell(suite.name), markdown_cell(c.name),
                          markdown_cell(lines(c.failures)));
    }
  }
  if (!rows.empty()) text += "\n| table | row | what differs |\n|---|---|---|\n" + rows;
  return text + '\n';
}

void append_step_summary(const std::string& markdown) {
  const char* path = std::getenv("GITHUB_STEP_SUMMARY");
  if (!path || !*path) return;
  std::FILE* file = std::fopen(path, "ab");
  bool good = file && std::fwrite(markdown.data(), 1, markdown.size(), file) == markdown.size();
  if (file) good = std::fclose(file) == 0 && good;
  if (!good) fmt::print(stderr, "framesim: note: the summary could not be added to '{}' (GITHUB_STEP_SUMMARY)\n", path);
}

}  // namespace framesim
