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

-- The glossary: what a word means, by its anchors.
local glossary = {}
for line in io.lines("chapters/README.md") do
    local anchors, meaning = line:match('^| (<a id=.-)%*%*.-%*%* | (.-) | ')
    for anchor in (anchors or ""):gmatch('"(.-)"') do
        glossary[anchor] = meaning:gsub("%[(.-)%]%(.-%)", "%1"):gsub("[$*`\\]", "")
    end
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
