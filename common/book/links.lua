-- Links between files of the project become links between pages, pictures become part of the page.
-- FOLDER: where the file is that is read; FOUND: gets the names of all files that it links to; BOOK: where the pages are.
local folder, book = os.getenv("FOLDER"), os.getenv("BOOK")
local found = io.open(os.getenv("FOUND"), "a")

local function in_project(path)
    if folder ~= "." then path = folder .. "/" .. path end
    local parts = {}
    for part in path:gmatch("[^/]+") do
        if part == ".." then table.remove(parts) elseif part ~= "." then parts[#parts + 1] = part end
    end
    return table.concat(parts, "/")
end
local function is_file(path)
    local file = io.open(path .. "/README.md") or io.open(path)
    return file and file:close()
end

-- The glossary: what a word means, by its anchors; and its entries.
local glossary, entries = {}, {}
for line in io.lines("chapters/README.md") do
    local anchors, word, meaning = line:match('^| (<a id=.-)%*%*(.-)%*%* | (.-) | ')
    meaning = (meaning or ""):gsub("%[(.-)%]%(.-%)", "%1"):gsub("[$*`\\]", "")
    for anchor in (anchors or ""):gmatch('"(.-)"') do glossary[anchor] = meaning end
    if anchors then entries[#entries + 1] = {anchors:match('"(.-)"'), word, meaning} end
end

function Link(link)
    local path, anchor = link.target:match("^([^#]*)(.*)$")
    if path == "" or path:match("^%a+:") then return nil end
    if is_file(in_project(path) .. "/README.md") then path = path:gsub("/?$", "/README.md") end
    local file = in_project(path)
    if not is_file(file) then error("a link to " .. file .. ", which is no file") end
    found:write(file .. "\n")
    if file == "chapters/README.md" then link.attributes["data-tip"] = glossary[anchor:sub(2)] end
    if path:match("README%.md$") then path = path:gsub("README%.md$", "index.html")
    elseif path:match("%.md$") then path = path:gsub("%.md$", ".html")
    else path = path:gsub("/$", "") .. ".html" end
    link.target = path .. anchor
    return link
end

-- A formula of its own line scrolls where it is too wide: not every browser lets <math> itself do that.
function Math(formula)
    if formula.mathtype == "DisplayMath" then return pandoc.Span({formula}, {class = "formula"}) end
end

-- A formula does not leave what ends its sentence.
function Inlines(inlines)
    for i = #inlines - 1, 1, -1 do
        if inlines[i].t == "Math" and (inlines[i + 1].text or ""):match("^[.,;:)]") then
            inlines[i] = pandoc.Span({inlines[i], inlines:remove(i + 1)}, {class = "together"})
        end
    end
    return inlines
end
function Str(word)
    if word.text:find("$", 1, true) then error("a formula that is not one: " .. word.text) end
end

-- Drawings become part of the page, in its colors. Other pictures are files of their own where they are photographs, and else
-- in the page, since a page cannot read the pixels of a file.
local captions, drawings, kinds = {}, 0, {png = "image/png", svg = "image/svg+xml"}
local colors = {["#888"] = "currentColor", ["#2a7fd4"] = "var(--blue)", ["#d4622a"] = "var(--orange)", ["#d4a017"] = "var(--gold)"}
function Image(image)
    if image.src:match("^%a+:") then error("a picture from elsewhere: " .. image.src) end
    local file = in_project(image.src)
    local chapter = file:match("^chapters/(%d%d)_[^/]*/strip.png$")
    if file:match("^chapters/.*%.svg$") then
        drawings = drawings + 1
        local name = "figure" .. drawings
        local svg = io.open(file):read("a"):gsub("#%x%x%x%x*", colors):gsub("<svg", '<svg class="figure ' .. name .. '"', 1)
        svg = svg:gsub("<style>(.-)</style>", "<style>." .. name .. " { %1 }</style>"):gsub(' id="', ' id="' .. name)
        svg = svg:gsub("url%(#", "url(#" .. name)
        captions[svg] = image.caption
        return pandoc.RawInline("html", svg)
    elseif file:match("%.jpg$") then
        os.execute("mkdir -p " .. book .. "/" .. file:match(".*/") .. " && cp " .. file .. " " .. book .. "/" .. file)
        image.attributes.loading = "lazy"
        return image
    end
    if chapter then
        local names = pandoc.pipe("common/tools/make_pictures", {"--names", chapter}, "")
        image.attributes["data-names"] = names:gsub("\n$", "")
    end
    image.src = "data:" .. kinds[file:match("%w+$")] .. ";base64," .. pandoc.pipe("base64", {"-w0", file}, "")
    return image
end

-- A picture in a paragraph of its own has a caption: what it shows.
function Para(para)
    local image = para.content[1]
    if #para.content ~= 1 then return nil end
    local caption = image.t == "Image" and image.caption or image.t == "RawInline" and captions[image.text]
    if not caption then return nil end
    return {pandoc.RawBlock("html", "<figure>"), pandoc.Plain(para.content), pandoc.RawBlock("html", "<figcaption>"),
        pandoc.Plain(caption), pandoc.RawBlock("html", "</figcaption></figure>")}
end

-- A listing says which file it is from.
function Blocks(blocks)
    for i = 2, #blocks do
        local comment = blocks[i - 1].t == "RawBlock" and blocks[i - 1].text or ""
        local file = comment:match("^<!%-%- listing: (%S+)") or comment:match("^<!%-%- file: (%S+)")
        if file and blocks[i].t == "CodeBlock" then blocks[i].attributes["data-file"] = file end
    end
    return blocks
end

-- Pictures that are written as HTML. Of a chapter's picture the front page shows a part.
function RawInline(raw)
    local src, alt = raw.text:match('^<img src="([^"]*)" alt="([^"]*)"')
    if not src then return nil end
    local chapter = folder == "." and src:match("^chapters/(%d[^/]*)/")
    if not chapter then return Image(pandoc.Image(alt, src)) end
    return pandoc.Image(alt, "book/" .. chapter .. ".jpg", "", {class = "thumbnail", loading = "lazy"})
end

-- What the search page searches in: of each section its address, page, heading and text. An entry of the glossary is one, too.
function Pandoc(doc)
    local page = os.getenv("PAGE")
    if page:match("%.%w+%.html$") or page:match("^common/book/") then return nil end
    local index = io.open(book .. "/book/sections.js", "a")
    local function add(anchor, title, heading, text)
        text = text:gsub("%s+", " ")
        if text:match("^ ?$") then return end
        index:write(string.format("sections.push([%q, %q, %q, %q]);\n", page .. "#" .. anchor, title, heading, text))
    end
    local title, anchor, blocks = pandoc.utils.stringify(doc.meta.pagetitle), "", {}
    local heading = title
    for _, block in ipairs(doc.blocks .. {pandoc.Header(1, {})}) do
        if block.t == "Header" then
            local section = pandoc.Div(blocks):walk({Math = function() return {} end})
            add(anchor, title, heading, pandoc.write(pandoc.Pandoc({section}), "plain", {columns = 1000}))
            anchor, heading, blocks = block.identifier, pandoc.utils.stringify(block), {}
        else
            blocks[#blocks + 1] = block
        end
    end
    for _, entry in ipairs(page == "chapters/index.html" and entries or {}) do add(entry[1], "Glossary", entry[2], entry[3]) end
    index:close()
end
