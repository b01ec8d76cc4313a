-- Links between files of the project become links between pages, pictures become part of the page.
-- FOLDER: where the file is that is read; FOUND: gets the names of all files that it links to.
local folder = os.getenv("FOLDER")
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

function Link(link)
    local path, anchor = link.target:match("^([^#]*)(.*)$")
    if path == "" or path:match("^%a+:") then return nil end
    if is_file(in_project(path) .. "/README.md") then path = path:gsub("/?$", "/README.md") end
    local file = in_project(path)
    if not is_file(file) then error("a link to " .. file .. ", which is no file") end
    found:write(file .. "\n")
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

local kinds = {jpg = "image/jpeg", png = "image/png", svg = "image/svg+xml"}
function Image(image)
    if image.src:match("^%a+:") then error("a picture from elsewhere: " .. image.src) end
    local file = in_project(image.src)
    local chapter = file:match("^chapters/(%d%d)_[^/]*/strip.png$")
    if chapter then
        local names = pandoc.pipe("common/tools/make_strips", {"--names", chapter}, "")
        image.attributes["data-names"] = names:gsub("\n$", "")
    end
    image.src = "data:" .. kinds[file:match("%w+$")] .. ";base64," ..
        pandoc.pipe("base64", {"-w0", file}, "")
    return image
end

-- Pictures that are written as HTML. Of a chapter's picture the front page shows a part.
function RawInline(raw)
    local src, alt = raw.text:match('^<img src="([^"]*)" alt="([^"]*)"')
    if not src then return nil end
    local chapter = folder == "." and src:match("^chapters/(%d[^/]*)/")
    if not chapter then return Image(pandoc.Image(alt, src)) end
    local data = pandoc.pipe("base64", {"-w0", os.getenv("THUMBS") .. "/" .. chapter .. ".png"}, "")
    return pandoc.Image(alt, "data:image/png;base64," .. data, "", {class = "thumbnail"})
end
