// The page of HTML is whole, and no text that it shows becomes part of its markup.
#include "report/page.hpp"

#include "report/page_files.hpp"
#include "report/png.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pugixml.hpp>

#include <stdexcept>
#include <string>

namespace vkfv {
namespace {

pugi::xml_document parsed(const std::string& page) {
    pugi::xml_document document;
    const auto result = document.load_string(page.c_str(), pugi::parse_default | pugi::parse_doctype);
    EXPECT_TRUE(result) << result.description();
    return document;
}

TEST(Page, ShowsTextsAsTheyAre) {
    report::Page page;
    page.section("one", "a < b & \"c\"");
    page.table("caption <", {{"", "one"}, {"</table>", "<b>"}});
    page.section("two", "two");
    page.folded("title", "key = \"<value>\"\nsecond = 2\n");
    const auto document = parsed(page.document("t < u", "x & y"));
    const auto body = document.child("html").child("body");
    EXPECT_STREQ(body.child("header").child("h1").child_value(), "t < u");
    EXPECT_STREQ(body.child("header").child("p").child_value(), "x & y");
    const auto first = body.child("main").child("section");
    EXPECT_STREQ(first.child("h2").child_value(), "a < b & \"c\"");
    const auto table = first.child("div").child("table");
    EXPECT_STREQ(table.child("caption").child_value(), "caption <");
    const auto row = table.child("tr").next_sibling("tr");
    EXPECT_STREQ(row.child("th").child_value(), "</table>");
    EXPECT_STREQ(row.child("td").child_value(), "<b>");
    EXPECT_STREQ(first.next_sibling().child("details").child("pre").child_value(), "key = \"<value>\"\nsecond = 2\n");
    // Every section can be gone to.
    const auto links = body.child("header").child("nav").child("ul");
    EXPECT_STREQ(links.last_child().child("a").attribute("href").value(), "#two");
    EXPECT_STREQ(first.next_sibling().attribute("id").value(), "two");
}

TEST(Page, CarriesItsPictures) {
    const std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\"><title>\"</title></svg>";
    report::Page page;
    page.section("s", "s");
    page.picture(svg, "what \"it\" shows");
    const auto document = parsed(page.document("t"));
    EXPECT_FALSE(document.child("html").child("body").child("header").child("p"));
    const auto image = document.child("html").child("body").child("main").child("section").child("p").child("img");
    EXPECT_STREQ(image.attribute("alt").value(), "what \"it\" shows");
    EXPECT_EQ(image.attribute("src").value(), "data:image/svg+xml;base64," + report::base64(svg));
}

TEST(Page, CarriesItsLibrariesAndTheirLicences) {
    report::Page page;
    page.section("s", "s");
    page.data("numbers", "[1, 2]");
    for (const char* script : {"d3.min.js", "d3-sankey.min.js", "three.min.js", "OrbitControls.js", "core.js"}) {
        page.script(script);
    }
    const auto text = page.document("t");
    const auto document = parsed(text);
    const auto body = document.child("html").child("body");
    EXPECT_STREQ(body.find_child_by_attribute("script", "id", "numbers").child_value(), "[1, 2]");
    EXPECT_THAT(text, testing::HasSubstr(report::page_file("core.js")));
    int licences = 0;
    for (const auto details : body.child("footer").children("details")) {
        EXPECT_GT(std::string(details.child("pre").child_value()).size(), 1000u);
        ++licences;
    }
    EXPECT_EQ(licences, 2);
    // The page asks no network for anything, except by code that is never run: names of other formats in the libraries.
    EXPECT_THAT(text, testing::Not(testing::HasSubstr("<link")));
    EXPECT_THAT(text, testing::Not(testing::HasSubstr(" src=\"http")));
    EXPECT_THROW(report::page_file("none.js"), std::out_of_range);
}

} // namespace
} // namespace vkfv
