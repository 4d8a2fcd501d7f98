// SPDX-License-Identifier: Apache-2.0
#include "report/html_text.h"

#include <gtest/gtest.h>

#include <cmath>

namespace relief::tools {
namespace {

TEST(HtmlText, EscapesWhatWouldBeMarkup) {
    EXPECT_EQ(html_escaped("a<b> & \"c\" 'd'"), "a&lt;b&gt; &amp; &quot;c&quot; &#39;d&#39;");
    EXPECT_EQ(script_escaped(R"({"a":"</script><!--"})"), R"({"a":"\u003c/script>\u003c!--"})");
}

TEST(HtmlText, DataUrisHaveTheBase64OfRfc4648) {
    const auto base64 = [](const char* text) {
        return data_uri(text, "t").substr(std::string("data:t;base64,").size());
    };
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64("\xFF\xFE\xFB"), "//77");
    EXPECT_EQ(data_uri("f", "image/png"), "data:image/png;base64,Zg==");
}

TEST(HtmlText, NumbersHaveThreeDigits) {
    EXPECT_EQ(number_text(0.0), "0");
    EXPECT_EQ(number_text(0.012345), "0.0123");
    EXPECT_EQ(number_text(0.5), "0.500");
    EXPECT_EQ(number_text(9.996), "10.0");
    EXPECT_EQ(number_text(99.96), "100");
    EXPECT_EQ(number_text(-45.678), "-45.7");
    EXPECT_EQ(number_text(1234.5), "1230");
    EXPECT_EQ(number_text(0.00099999), "0.00100");
    EXPECT_EQ(number_text(0.00012345), "1.23e-04");
    EXPECT_EQ(number_text(1.5e7 + 0.5), "1.50e+07");
    EXPECT_EQ(number_text(8192.0), "8192") << "whole numbers stay whole";
    EXPECT_EQ(number_text({}), "–");
    EXPECT_EQ(number_text(NAN), "–");
}

TEST(HtmlText, RangesNameTheirUnitOnce) {
    EXPECT_EQ(range_text(0.00119, 0.00128), "1.19–1.28 ms");
    EXPECT_EQ(range_text(0.00099, 0.00102), "990 µs–1.02 ms");
}

TEST(HtmlText, BytesBelowAThousandAreNotRounded) {
    EXPECT_EQ(bytes_text(1.25), "1.25 B");
    EXPECT_EQ(bytes_text(4.0), "4 B");
    EXPECT_EQ(bytes_text(2000000.0), "2.0 MB");
    EXPECT_EQ(bytes_text({}), "–");
}

}  // namespace
}  // namespace relief::tools
