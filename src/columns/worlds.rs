//! Worlds as one Parquet or Arrow file, for use at scale. Drawing the worlds is the generator's job.
//!
//! A row is a world: where it comes from (`task`, `variant`, `seed`, `index`), its content hash, the world itself as JSON, and
//! beside it what most analyses want without reading the JSON: the agent's start and a list of objects.
//!
//! ```text
//! >>> import pyarrow.parquet as pq
//! >>> table = pq.read_table("worlds.parquet")
//! >>> table["objects"][0][0]
//! {'class': 'geometric', 'model': '1', 'x': -3.1, 'y': 8.5, 'heading': 0.0, 'scale': 1.0, 'reward': 100.0, 'tag': 'targets'}
//! ```

use std::io::Write;
use std::sync::{Arc, LazyLock};

use arrow_array::builder::{Float64Builder, ListBuilder, StringBuilder, StructBuilder, UInt64Builder};
use arrow_array::{ArrayRef, RecordBatch};
use arrow_schema::{ArrowError, DataType, Field, Fields, Schema, SchemaRef};
use driftworld_spec::World;

use super::sink::Sink;
use super::{ColumnsError, Format};

/// How many worlds are gathered before they are written.
const ROWS: usize = 1024;

/// How many bytes of JSON are gathered before they are written: memory is bounded by it and by one world.
const BYTES: usize = 64 << 20;

/// A world and where it comes from.
#[derive(Clone, Copy, Debug)]
pub struct Row<'a> {
    /// The task's name.
    pub task: &'a str,
    /// The variant's name.
    pub variant: &'a str,
    /// The seed that it was drawn under.
    pub seed: u64,
    /// Its number under the seed.
    pub index: u64,
    /// The world.
    pub world: &'a World,
}

/// A table of worlds on its way to a file. The same rows give the same bytes.
pub struct WorldTable<W: Write + Send> {
    sink: Sink<W>,
    rows: Rows,
}

impl<W: Write + Send> WorldTable<W> {
    /// Begins a table.
    ///
    /// # Errors
    /// [`ColumnsError`] if the beginning of the file cannot be written.
    pub fn new(writer: W, format: Format) -> Result<Self, ColumnsError> {
        Ok(Self {
            sink: Sink::new(writer, schema(), format)?,
            rows: Rows::default(),
        })
    }

    /// Adds a world.
    ///
    /// # Errors
    /// [`ColumnsError`] if what was gathered cannot be written.
    pub fn push(&mut self, row: Row) -> Result<(), ColumnsError> {
        self.rows.push(row);
        if self.rows.count == ROWS || self.rows.bytes >= BYTES {
            self.flush()
        } else {
            Ok(())
        }
    }

    fn flush(&mut self) -> Result<(), ColumnsError> {
        if self.rows.count == 0 {
            return Ok(());
        }
        let batch = self.rows.take()?;
        self.sink.write(&batch)
    }

    /// Ends the table and hands back what it was written to.
    ///
    /// # Errors
    /// [`ColumnsError`] if the rest of the file cannot be written.
    pub fn finish(mut self) -> Result<W, ColumnsError> {
        self.flush()?;
        self.sink.finish()
    }
}

/// The columns of an object.
static OBJECT: LazyLock<Fields> = LazyLock::new(|| {
    let number = |name| Field::new(name, DataType::Float64, false);
    Fields::from(vec![
        Field::new("class", DataType::Utf8, false),
        Field::new("model", DataType::Utf8, false),
        number("x"),
        number("y"),
        number("heading"),
        number("scale"),
        number("reward"),
        Field::new("tag", DataType::Utf8, true),
    ])
});

/// The columns of the table.
fn schema() -> SchemaRef {
    let field = |name, kind| Field::new(name, kind, false);
    let item = Field::new("item", DataType::Struct(OBJECT.clone()), false);
    let columns = vec![
        field("task", DataType::Utf8),
        field("variant", DataType::Utf8),
        field("seed", DataType::UInt64),
        field("index", DataType::UInt64),
        field("hash", DataType::Utf8),
        field("agent_x", DataType::Float64),
        field("agent_y", DataType::Float64),
        field("agent_heading", DataType::Float64),
        field("objects", DataType::List(Arc::new(item))),
        field("world", DataType::Utf8),
    ];
    let metadata = [("driftworld.columns".to_owned(), "1".to_owned())];
    Arc::new(Schema::new_with_metadata(columns, metadata))
}

/// Rows that wait to be written.
struct Rows {
    count: usize,
    bytes: usize,
    task: StringBuilder,
    variant: StringBuilder,
    seed: UInt64Builder,
    index: UInt64Builder,
    hash: StringBuilder,
    agent: [Float64Builder; 3],
    objects: ListBuilder<StructBuilder>,
    world: StringBuilder,
}

impl Default for Rows {
    fn default() -> Self {
        let item = Field::new("item", DataType::Struct(OBJECT.clone()), false);
        Self {
            count: 0,
            bytes: 0,
            task: StringBuilder::new(),
            variant: StringBuilder::new(),
            seed: UInt64Builder::new(),
            index: UInt64Builder::new(),
            hash: StringBuilder::new(),
            agent: std::array::from_fn(|_| Float64Builder::new()),
            objects: ListBuilder::new(StructBuilder::from_fields(OBJECT.clone(), 0)).with_field(item),
            world: StringBuilder::new(),
        }
    }
}

impl Rows {
    fn push(&mut self, row: Row) {
        self.count += 1;
        self.task.append_value(row.task);
        self.variant.append_value(row.variant);
        self.seed.append_value(row.seed);
        self.index.append_value(row.index);
        self.hash.append_value(row.world.hash());
        let agent = &row.world.agent_params;
        let start = [agent.coordinates[0], agent.coordinates[1], agent.heading];
        for (column, number) in self.agent.iter_mut().zip(start) {
            column.append_value(number);
        }
        for object in &row.world.objects {
            let columns = self.objects.values();
            let words = [Some(object.class.as_str()), Some(object.model.0.as_str())];
            for (column, word) in [0, 1, 7]
                .into_iter()
                .zip(words.into_iter().chain([object.tag.as_deref()]))
            {
                columns
                    .field_builder::<StringBuilder>(column)
                    .expect("the column holds text")
                    .append_option(word);
            }
            let [x, y] = object.coordinates;
            for (column, number) in (2..).zip([x, y, object.heading, object.scale, object.reward]) {
                columns
                    .field_builder::<Float64Builder>(column)
                    .expect("the column holds numbers")
                    .append_value(number);
            }
            columns.append(true);
        }
        self.objects.append(true);
        let json = row.world.to_json();
        self.bytes += json.len();
        self.world.append_value(json);
    }

    /// The rows as a batch; none are left.
    fn take(&mut self) -> Result<RecordBatch, ArrowError> {
        (self.count, self.bytes) = (0, 0);
        let [x, y, heading] = &mut self.agent;
        let columns: Vec<ArrayRef> = vec![
            Arc::new(self.task.finish()),
            Arc::new(self.variant.finish()),
            Arc::new(self.seed.finish()),
            Arc::new(self.index.finish()),
            Arc::new(self.hash.finish()),
            Arc::new(x.finish()),
            Arc::new(y.finish()),
            Arc::new(heading.finish()),
            Arc::new(self.objects.finish()),
            Arc::new(self.world.finish()),
        ];
        RecordBatch::try_new(schema(), columns)
    }
}

/// What a file of a table holds; panics where it is no such file.
#[cfg(test)]
pub(crate) fn read_back(bytes: Vec<u8>, format: Format) -> Vec<RecordBatch> {
    match format {
        Format::Parquet => {
            let mut file = tempfile::tempfile().unwrap();
            file.write_all(&bytes).unwrap();
            let reader = parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder::try_new(file).unwrap();
            reader.build().unwrap().collect::<Result<_, _>>().unwrap()
        }
        Format::Arrow => arrow_ipc::reader::FileReader::try_new(std::io::Cursor::new(bytes), None)
            .unwrap()
            .collect::<Result<_, _>>()
            .unwrap(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arrow_array::cast::AsArray;
    use arrow_array::types::{Float64Type, UInt64Type};
    use driftworld_spec::{Object, WorldDraft};

    fn worlds(count: u64) -> Vec<World> {
        (0..count)
            .map(|index| {
                let mut world = WorldDraft::default();
                world.agent_params.heading = index as f64 % 360.0;
                for number in 0..index % 4 {
                    let mut object = Object::new("tree", [number as f64, -2.5]);
                    object.tag = (number == 1).then(|| "trees".to_owned());
                    world.objects.push(object);
                }
                world.check().unwrap()
            })
            .collect()
    }

    fn written(worlds: &[World], format: Format) -> Vec<u8> {
        let mut table = WorldTable::new(Vec::new(), format).unwrap();
        for (index, world) in worlds.iter().enumerate() {
            table
                .push(Row {
                    task: "t",
                    variant: "v",
                    seed: 7,
                    index: index as u64,
                    world,
                })
                .unwrap();
        }
        table.finish().unwrap()
    }

    #[test]
    fn every_column_comes_back() {
        let worlds = worlds(2500);
        for format in [Format::Parquet, Format::Arrow] {
            let mut index = 0;
            for batch in read_back(written(&worlds, format), format) {
                let column = |name: &str| batch.column_by_name(name).unwrap();
                for row in 0..batch.num_rows() {
                    let world = &worlds[index];
                    assert_eq!(column("index").as_primitive::<UInt64Type>().value(row), index as u64);
                    assert_eq!(column("hash").as_string::<i32>().value(row), world.hash());
                    let again = World::from_json("w", column("world").as_string::<i32>().value(row)).unwrap();
                    assert_eq!(again, *world);
                    let heading = column("agent_heading").as_primitive::<Float64Type>().value(row);
                    assert_eq!(heading, world.agent_params.heading);
                    let objects = column("objects").as_list::<i32>().value(row);
                    let objects = objects.as_struct();
                    let x = objects.column_by_name("x").unwrap().as_primitive::<Float64Type>();
                    assert_eq!(
                        x.values(),
                        &world.objects.iter().map(|o| o.coordinates[0]).collect::<Vec<_>>()[..]
                    );
                    let tags = objects.column_by_name("tag").unwrap().as_string::<i32>();
                    let found: Vec<Option<&str>> = tags.iter().collect();
                    assert_eq!(
                        found,
                        world.objects.iter().map(|o| o.tag.as_deref()).collect::<Vec<_>>()
                    );
                    index += 1;
                }
            }
            assert_eq!(index, worlds.len(), "{format:?}");
        }
    }

    #[test]
    fn the_same_worlds_give_the_same_bytes_and_none_give_a_table() {
        let worlds = worlds(10);
        for format in [Format::Parquet, Format::Arrow] {
            assert_eq!(written(&worlds, format), written(&worlds, format));
            assert_eq!(
                read_back(written(&[], format), format)
                    .iter()
                    .map(RecordBatch::num_rows)
                    .sum::<usize>(),
                0
            );
        }
    }
}
