#include "detail/page_parts.hpp"
#include "study/plot/dark_picture.hpp"

namespace skyloop {
namespace {

constexpr std::string_view light_sheet = R"(:root {
  --ink: #1f2933; --faint: #5f6b7a; --line: #cbd3dd; --soft: #e3e8ef; --paper: #ffffff; --panel: #f6f8fb;
  --accent: #b4540a; --series: #1f5fbf; --good: #0a8f72; --bad: #b3403a;
}
body { margin: 0; background: var(--panel); color: var(--ink);
  font: 15px/1.5 system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', Arial, sans-serif; }
main { max-width: 920px; margin: 0 auto; padding: 28px 24px 60px; }
h1 { font-size: 26px; margin: 0 0 18px; } h2 { font-size: 20px; margin: 44px 0 10px; }
h3 { font-size: 16px; margin: 34px 0 8px; } p { margin: 8px 0; max-width: 74ch; }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(138px, 1fr)); gap: 10px; }
.tile { background: var(--paper); border: 1px solid var(--line); border-radius: 10px; padding: 10px 14px; }
.tile span, .tile small { display: block; color: var(--faint); font-size: 12.5px; }
.tile b { font-size: 23px; font-weight: 600; font-variant-numeric: tabular-nums; }
.tile.warns b { color: var(--bad); }
.notice { border-left: 4px solid var(--accent); background: var(--paper); padding: 8px 14px; max-width: none; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; margin: 10px 0; font-size: 13.5px; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: 4px 14px 4px 0; border-bottom: 1px solid var(--soft); vertical-align: top; }
th { font-weight: 600; } thead th { color: var(--faint); font-weight: 500; border-bottom-color: var(--line); }
td.n, th.n { text-align: right; white-space: nowrap; }
table.facts th { color: var(--faint); font-weight: 500; white-space: nowrap; }
table.facts td { overflow-wrap: anywhere; }
code { font: 12.5px/1.4 ui-monospace, 'DejaVu Sans Mono', Menlo, Consolas, monospace; }
td code.command { white-space: nowrap; user-select: all; background: var(--soft); border-radius: 4px; padding: 1px 6px; }
svg { display: block; width: 100%; height: auto; }
.pair { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(440px, 100%), 1fr)); gap: 16px 20px; align-items: start; }
figure { margin: 10px 0; } figcaption { font-size: 13px; color: var(--faint); margin: 0 0 6px; min-height: 2.9em; }
figcaption b { color: var(--ink); font-weight: 600; }
.seen { color: var(--accent); font-weight: 600; } .faint { color: var(--faint); }
summary { cursor: pointer; color: var(--series); margin: 8px 0; }
)";

constexpr std::string_view dark_sheet = R"(@media (prefers-color-scheme: dark) {
:root {
  --ink: #e4e9ef; --faint: #9aa7b5; --line: #3a4653; --soft: #2b3540; --paper: #161c23; --panel: #10151b;
  --accent: #ec9a55; --series: #6ba3f5; --good: #3cc3a0; --bad: #f0817a;
}
)";

constexpr std::string_view print_sheet =
    R"(@media print { body { background: none; } figure, tr { break-inside: avoid; } }
)";

}  // namespace

std::string style_sheet() {
    std::string sheet(light_sheet);
    sheet += print_sheet;
    sheet += dark_sheet;
    return sheet + dark_picture_rules() + "}\n";
}

}  // namespace skyloop
