// SPDX-License-Identifier: Apache-2.0
// The runtime of pages made small. view_page_test.py runs it in a browser.
#include "short_script.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "webgl_constants.h"

namespace relief::tools {
namespace {

TEST(ShortScript, HasNoCommentsAndNeedlessSpaces) {
    EXPECT_EQ(short_script("// Before.\n\n  f(1);  // After.\n/* One.\n Two. */\n\tg('x // y');\n"),
              "f(1);g('x // y');");
    EXPECT_EQ(short_script("throw a + +b - -c;\nif (x) return a++ + b / c;\nelse y = 0.5 * z;\n"),
              "throw a+ +b- -c;if(x)return a++ +b/c;else y=0.5*z;");
}

TEST(ShortScript, KeepsTextsPatternsAndTemplates) {
    EXPECT_EQ(
        short_script(
            "f(`a, ${b ? `, ${ g({c : 1}) }` : \"x ; y\"} , z`, /[ /]= , \\/ /i , 'it\\'s ');"),
        "f(`a, ${b?`, ${g({c:1})}`:\"x ; y\"} , z`,/[ /]= , \\/ /i,'it\\'s ');");
}

TEST(ShortScript, RenamesWhatAPieceDeclares) {
    EXPECT_EQ(
        short_script(
            "function sum(first, second = 2) {\n  const total = first + second, half = total / 2;\n"
            "  return half;\n}\nconst [left, right] = sum(1);\n"),
        "function Aa(a,c=2){const d=a+c,b=d/2;return b;}const[Ab,Ac]=Aa(1);");
}

TEST(ShortScript, KeepsKeysMethodsAndProperties) {
    // `width` and `depth` are short keys, `size` is a method, and `a` a name of its own.
    EXPECT_EQ(
        short_script(
            "class Box {\n  size(scale, {depth}) {\n    const {width} = this.data, all = [scale, "
            "width], kept = a;\n    return scale > 1 ? kept : f({size: a, scale: all.scale}, "
            "...all);\n  }\n}\nnew Box().size(2);\n"),
        "class Aa{size(c,{depth}){const{width}=this.data,b=[c,width],d=a;"
        "return c>1?d:f({size:a,scale:b.scale},...b);}}new Aa().size(2);");
    EXPECT_EQ(
        short_script("function g(p, q) {\n  const y = p;\n  return f({x: `${p}, ${q}`, y});\n}\n"),
        "function g(a,b){const y=a;return f({x:`${a}, ${b}`,y});}");
    EXPECT_EQ(short_script(
                  "const code = 1, light = code;\nfunction* f(light) {\n  for (const [at, more] of "
                  "light) yield at + more + code;\n}\n"),
              "const Aa=1,Ab=Aa;function*f(Ab){for(const[a,b]of Ab)yield a+b+Aa;}");
}

TEST(ShortScript, ReplacesConstants) {
    const std::vector<ScriptConstant> constants = {{"LINES", 1}, {"TEXTURE_2D", 0xde1}};
    EXPECT_EQ(short_script("draw(gl.LINES, gl.TEXTURE_2D, gl.OTHER, a.gl.LINES);", constants),
              "draw(1,3553,gl.OTHER,a.gl.LINES);");
    EXPECT_EQ(short_script("f(gl.FLOAT, gl.RGB9_E5);", webgl_constants), "f(5126,35901);");
}

TEST(ShortStyle, HasNoCommentsAndNeedlessSpaces) {
    EXPECT_EQ(short_style("/* One.\n   Two. */\n@media (a: dark) { :root { --x: #fff; } }\n.a b, "
                          ".c :hover { margin: 0 1em; top: 0; }\n"),
              "@media (a:dark){:root{--x:#fff}}.a b,.c :hover{margin:0 1em;top:0}");
}

}  // namespace
}  // namespace relief::tools
