#include "tests/golden/report.h"

#include "app/render/png.h"

#include <fstream>
#include <stdexcept>
#include <string_view>

namespace plumb::golden {

namespace {

namespace fs = std::filesystem;

fs::path report_dir(const Case &golden) {
    return fs::path(PLUMB_ARTEFACTS) / "golden" / golden.name;
}

std::string escaped(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '<')
            out += "&lt;";
        else if (c == '&')
            out += "&amp;";
        else
            out += c;
    }
    return out;
}

} // namespace

const char *const bless_command = PLUMB_SOURCE_DIR "/tests/golden/bless " PLUMB_BUILD_DIR;

fs::path write_report(const Case &golden, const std::optional<Record> &record,
                      const Rendering &present, const Verdict &verdict) {
    remove_report(golden);
    const fs::path dir = report_dir(golden);
    fs::create_directories(dir);
    struct Figure {
        const char *file;
        const char *caption;
        const Image *picture;
    };
    const Figure figures[]{
        {"expected.png", "Expected", record ? &record->picture : nullptr},
        {"actual.png", "Actual", &present.picture},
        {"difference.png", "Difference (FLIP: black is equal, then violet to yellow)",
         &verdict.difference.picture},
    };
    const fs::path page = dir / "index.html";
    std::ofstream out(page, std::ios::trunc);
    out << "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>" << golden.name
        << "</title>\n<style>body{font:15px sans-serif;margin:2em}figure{display:inline-block;"
           "margin:0 1em 1em 0}img{width:600px;max-width:95vw;image-rendering:pixelated;border:1px "
           "solid #888}pre{white-space:pre-wrap}</style>\n<h1>"
        << golden.name << "</h1>\n<p>Scene " << golden.scene << ", step " << golden.step
        << "</p>\n<pre>" << escaped(verdict.text) << "</pre>\n";
    for (const Figure &figure : figures) {
        if (!figure.picture || figure.picture->empty())
            continue;
        write_png(dir / figure.file, *figure.picture);
        out << "<figure><img src=\"" << figure.file << "\" alt=\"\"><figcaption>" << figure.caption
            << "</figcaption></figure>\n";
    }
    out << "<p>If the new picture is right: <code>" << escaped(bless_command)
        << "</code></p></html>\n";
    out.close();
    if (!out)
        throw std::runtime_error(page.string() + ": could not be written");
    return page;
}

void remove_report(const Case &golden) {
    fs::remove_all(report_dir(golden));
}

} // namespace plumb::golden
