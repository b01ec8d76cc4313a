-- A chapter's page as slides: its headlines, formulas, tables, pictures, listings and output, and of its text the first
-- sentence of each paragraph; questions and exercises are whole. FOLDER: where the page is.
local folder = os.getenv("FOLDER")
local left_out = {["Break it"] = true, Check = true, Read = true}
local slides, title, lines = {}, "", 0
local most = 17  -- lines of text on a slide

local function text_of(blocks) return pandoc.utils.stringify(blocks) end

local function begin(more)
    slides[#slides + 1] = pandoc.Header(1, {pandoc.Str(title .. (more and " (continued)" or ""))})
    lines = 0
end
local function put(block, height)
    if lines > 0 and lines + height > most then begin(true) end
    slides[#slides + 1] = block
    lines = lines + height
end

-- The first sentence.
local whole = {Predict = true, Exercises = true}
local function first_sentence(inlines)
    if whole[title] then return inlines end
    local kept = pandoc.Inlines({})
    for i, inline in ipairs(inlines) do
        kept:insert(inline)
        local after = inlines[i + 1]
        local ends = inline.t == "Str" and inline.text:match("[.?!]$") and not inline.text:match("^%d*%.$")
        if ends and (not after or after.t == "Space" or after.t == "SoftBreak") then break end
    end
    return kept
end
local function height_of(inlines) return 1 + #text_of(inlines) / 80 end

local function put_rows(table_block)
    local rows = table_block.bodies[1].body
    local now, height = {}, 1.2
    local function flush()
        if #now == 0 then return end
        local part = table_block:clone()
        part.bodies[1].body = now
        put(part, height)
        now, height = {}, 1.2
    end
    for _, row in ipairs(rows) do
        local longest, all = 0, 0
        for _, cell in ipairs(row.cells) do
            local characters = #text_of(cell.contents)
            longest, all = math.max(longest, characters), all + characters
        end
        local rows_height = 0.35 + 0.85 * math.max(math.ceil(longest / 55), math.ceil(all / 105))
        if height + rows_height > most then flush() begin(true) end
        now[#now + 1] = row
        height = height + rows_height
    end
    flush()
end

local function put_code(code)
    local part, count = {}, 0
    local function flush()
        if count == 0 then return end
        put(pandoc.CodeBlock(table.concat(part, "\n"), code.attr), count * 0.62 + 1)
        part, count = {}, 0
    end
    for line in (code.text .. "\n"):gmatch("(.-)\n") do
        part[#part + 1] = line
        count = count + 1
        if count == 24 then flush() end
    end
    flush()
end

local function add(block)
    if block.t == "Para" or block.t == "Plain" then
        local picture = #block.content == 1 and (block.content[1].t == "Image" or
            (block.content[1].t == "Math" and block.content[1].mathtype == "DisplayMath"))
        if picture then
            put(block, block.content[1].t == "Image" and 11 or 3)
        elseif #block.content > 0 and not text_of(block):match("^Answers:") then
            local sentence = first_sentence(block.content)
            put(pandoc.Para(sentence), height_of(sentence))
        end
    elseif block.t == "BulletList" or block.t == "OrderedList" then
        for i, item in ipairs(block.content) do
            local sentence = first_sentence(item[1].content or {})
            local list = block.t == "BulletList" and pandoc.BulletList({{pandoc.Plain(sentence)}}) or
                pandoc.OrderedList({{pandoc.Plain(sentence)}}, pandoc.ListAttributes(i))
            put(list, height_of(sentence))
        end
    elseif block.t == "Table" then
        put_rows(block)
    elseif block.t == "CodeBlock" and not block.classes:includes("diff") then
        put_code(block)
    end
end

function Pandoc(doc)
    local shown = false
    for _, block in ipairs(doc.blocks) do
        if block.t == "Header" and block.level == 1 then
            doc.meta.title = pandoc.MetaInlines(block.content)
            doc.meta.author = pandoc.MetaInlines({pandoc.Str("Path by Path")})
        elseif block.t == "Header" then
            shown = not left_out[text_of(block)]
            title = text_of(block)
            if shown then begin(false) end
        elseif shown and not text_of(block):match("^Before: ") and not text_of(block):match("^Next: ") then
            add(block)
        end
    end
    local function link(link) return link.content end
    local kinds = {png = "image/png", svg = "image/svg+xml"}
    local function image(image)
        image.src = "data:" .. kinds[image.src:match("%w+$")] .. ";base64," ..
            pandoc.pipe("base64", {"-w0", folder .. "/" .. image.src}, "")
        return image
    end
    -- A headline with nothing under it is no slide.
    local kept = pandoc.Blocks({})
    for i, block in ipairs(slides) do
        local after = slides[i + 1]
        if block.t ~= "Header" or (after and after.t ~= "Header") then kept:insert(block) end
    end
    doc.blocks = kept:walk({Link = link, Image = image})
    return doc
end
