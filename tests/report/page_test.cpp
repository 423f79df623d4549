// The page of HTML: it is whole, and nothing that it shows becomes part of its markup.
#include "report/page.hpp"

#include "report/png.hpp"

#include <gtest/gtest.h>
#include <pugixml.hpp>

#include <string>

namespace vkfv {
namespace {

pugi::xml_document parsed(const std::string& page) {
    pugi::xml_document document;
    const auto result = document.load_string(page.c_str(), pugi::parse_default | pugi::parse_doctype);
    EXPECT_TRUE(result) << result.description();
    return document;
}

TEST(Page, shows_texts_as_they_are) {
    report::Page page;
    page.heading("a < b & \"c\"");
    page.table({{"head", "one"}, {"</table>", "<b>"}});
    page.folded("title", "key = \"<value>\"\nsecond = 2\n");
    const auto document = parsed(page.document("t < u"));
    const auto body = document.child("html").child("body");
    EXPECT_STREQ(body.child("h1").child_value(), "t < u");
    EXPECT_STREQ(body.child("h2").child_value(), "a < b & \"c\"");
    const auto second = body.child("table").first_child().next_sibling();
    EXPECT_STREQ(second.first_child().child_value(), "</table>");
    EXPECT_STREQ(second.last_child().child_value(), "<b>");
    EXPECT_STREQ(body.child("details").child("pre").child_value(), "key = \"<value>\"\nsecond = 2\n");
}

TEST(Page, carries_its_pictures) {
    const std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\"><title>\"</title></svg>";
    report::Page page;
    page.picture(svg, "what \"it\" shows");
    const auto document = parsed(page.document("t"));
    const auto image = document.child("html").child("body").child("p").child("img");
    EXPECT_STREQ(image.attribute("alt").value(), "what \"it\" shows");
    EXPECT_EQ(image.attribute("src").value(), "data:image/svg+xml;base64," + report::base64(svg));
}

} // namespace
} // namespace vkfv
